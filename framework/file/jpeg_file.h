// JPEG pictures through stb: input only.
#pragma once

#include <filesystem>
#include <string_view>

#include "framework/image/image.h"

namespace aftershade {

/// Whether a file begins as a JPEG does. False where it cannot be read.
bool is_jpeg_file(const std::filesystem::path& path);

/// One or three channels of 8 bits as 0 to 1, rows from the top; orientation and profiles are left out.
/// Throws Error(ErrorKind::capture) that begins with the path: missing, damaged, cut off (stb itself would
/// fill the rest with grey).
Image read_jpeg(const std::filesystem::path& path);
/// The same, of bytes in memory; `name` stands for the path.
Image decode_jpeg(const std::filesystem::path& name, std::string_view bytes);

}  // namespace aftershade
