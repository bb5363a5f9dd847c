// PNG through stb: output of 8 bits a channel, input of 8 or 16.
#pragma once

#include <filesystem>

#include "framework/image/image.h"

namespace aftershade {

/// Writes display-referred values in [0, 1], already encoded, of 1, 3 or 4 float channels: round(255 *
/// clamp(v)), NaN as 0. A fourth channel is unassociated alpha. Appears by rename from a temporary file in
/// the same folder. Throws Error(ExitCode::output).
void write_png(const std::filesystem::path& path, const Image& display);

/// Reads PNG of 8 or 16 bits into [0, 1] floats, 1 to 4 channels as stored. Throws Error(ExitCode::capture).
Image read_png(const std::filesystem::path& path);

}  // namespace aftershade
