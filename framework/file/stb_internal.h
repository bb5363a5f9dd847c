// stb_image and stb_image_write, compiled into the source that includes this. Define STBI_ONLY_PNG or
// STBI_ONLY_HDR before it. Internal to framework/image.
#pragma once

#include <filesystem>
#include <string>

#include "framework/core/error.h"

// Internal linkage, so that another copy of stb in the program cannot be linked instead of this one.
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace aftershade::stb {

[[noreturn]] inline void fail(const std::filesystem::path& path, const std::string& what) {
    throw Error(ExitCode::capture, path.string() + ": " + what);
}

}  // namespace aftershade::stb
