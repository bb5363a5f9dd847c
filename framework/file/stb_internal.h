// stb_image and stb_image_write, compiled into the source that includes this. Define STBI_ONLY_PNG,
// STBI_ONLY_JPEG or STBI_ONLY_HDR before it. Internal to framework/image.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include "framework/base/error.h"

namespace aftershade::stb {

/// Memory that stb may still take for one file; it allocates what a file claims, and unpacks what a file
/// packs.
inline thread_local std::size_t bytes_left = 0;

/// With the size before it, which free() needs.
inline constexpr std::size_t kHead = 16;

inline void* take(std::size_t bytes) {
    if (bytes > bytes_left || bytes_left - bytes < kHead) return nullptr;
    void* const block = std::malloc(bytes + kHead);
    if (!block) return nullptr;
    bytes_left -= bytes + kHead;
    std::memcpy(block, &bytes, sizeof bytes);
    return static_cast<std::byte*>(block) + kHead;
}

inline void give(void* pointer) {
    if (!pointer) return;
    std::byte* const block = static_cast<std::byte*>(pointer) - kHead;
    std::size_t bytes = 0;
    std::memcpy(&bytes, block, sizeof bytes);
    bytes_left += bytes + kHead;
    std::free(block);
}

inline void* take_again(void* pointer, std::size_t old_bytes, std::size_t bytes) {
    void* const block = take(bytes);
    if (!block) return nullptr;
    if (pointer) std::memcpy(block, pointer, std::min(old_bytes, bytes));
    give(pointer);
    return block;
}

}  // namespace aftershade::stb

#define STBI_MALLOC(bytes) aftershade::stb::take(bytes)
#define STBI_REALLOC_SIZED(pointer, old_bytes, bytes) aftershade::stb::take_again(pointer, old_bytes, bytes)
#define STBI_FREE(pointer) aftershade::stb::give(pointer)
// The sized form is the one that stb calls.
#define STBI_REALLOC(pointer, bytes) (static_cast<void>(pointer), static_cast<void>(bytes), nullptr)

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

/// Largest size of a picture as floats; the same as ReadLimits::max_image_bytes for OpenEXR.
inline constexpr std::uint64_t kMaxImageBytes = 512ull * 1024 * 1024;

/// Why a picture of this size is not read; "" where it is. Then stb may take what it needs for it: the pixels
/// unpacked, the pixels filtered back, and room to grow into.
inline std::string fault_of_size(int width, int height, int channels) {
    if (width < 1 || height < 1)
        return "damaged: it is " + std::to_string(width) + " x " + std::to_string(height) + " px";
    const std::uint64_t values = std::uint64_t(width) * std::uint64_t(height) * std::uint64_t(channels);
    constexpr std::uint64_t kSpareBytes = 64ull * 1024 * 1024;
    bytes_left = std::size_t(4 * values * sizeof(float) + kSpareBytes);
    if (values * sizeof(float) <= kMaxImageBytes) return "";
    return std::to_string(width) + " x " + std::to_string(height) + " px of " + std::to_string(channels) +
           " channels take " + std::to_string(values * sizeof(float)) + " bytes as floats, the limit is " +
           std::to_string(kMaxImageBytes) + " (crop the picture or scale it down)";
}

[[noreturn]] inline void fail(const std::filesystem::path& path, const std::string& what) {
    throw Error(ErrorKind::capture, path.string() + ": " + what);
}

}  // namespace aftershade::stb
