// Radiance pictures (.hdr, RGBE) through stb: input only.
#pragma once

#include <filesystem>

#include "framework/image/image.h"

namespace aftershade {

/// Whether a file begins as a Radiance picture does. False where it cannot be read.
bool is_hdr_file(const std::filesystem::path& path);

/// Three channels, scene-linear, rows from the top. Throws Error(ErrorKind::capture) that begins with the
/// path: missing, damaged, cut off (stb itself would fill the rest with zeros).
Image read_hdr(const std::filesystem::path& path);

}  // namespace aftershade
