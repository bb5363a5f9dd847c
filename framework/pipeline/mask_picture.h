// A step's mask out of a file.
#pragma once

#include <filesystem>
#include <utility>

#include "framework/image/image.h"

namespace aftershade {

/// One channel as stored: the first of a PNG (0 to 1, not decoded), or an EXR's R, else Y, else its first.
/// Throws Error(ExitCode::capture) naming the file.
Image read_mask_picture(const std::filesystem::path& path);

}  // namespace aftershade
