// The image of shading rates as files.
#pragma once

#include <filesystem>

#include "framework/image/image.h"

namespace aftershade::scene {

/// One float channel, "rate". By rename. Throws Error(ErrorKind::output).
void write_rate_exr(const std::filesystem::path& path, const Image& rate);

/// Heat: viridis over log2(1 + rate), from none to 64 shadings a pixel. By rename. Throws
/// Error(ErrorKind::output).
void write_rate_png(const std::filesystem::path& path, const Image& rate);

}  // namespace aftershade::scene
