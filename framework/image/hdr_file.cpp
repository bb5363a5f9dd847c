#include "framework/image/hdr_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>

#include "framework/core/error.h"

// Internal linkage, so that another copy of stb in the program cannot be linked instead of this one.
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace aftershade {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
    throw Error(ExitCode::capture, path.string() + ": " + what);
}

/// What stb reads from, and whether it asked for more than there is.
struct Source {
    std::ifstream file;
    bool past_end = false;
};

int read_source(void* user, char* bytes, int count) {
    Source& source = *static_cast<Source*>(user);
    source.file.read(bytes, count);
    const int got = int(source.file.gcount());
    if (got == 0) source.past_end = true;
    return got;
}

void skip_source(void* user, int count) {
    static_cast<Source*>(user)->file.seekg(count, std::ios::cur);
}

int is_at_end(void* user) {
    return static_cast<Source*>(user)->file.eof() ? 1 : 0;
}

}  // namespace

bool is_hdr_file(const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return false;
    char begin[6] = {};
    std::ifstream(path, std::ios::binary).read(begin, sizeof begin);
    const std::string_view text(begin, sizeof begin);
    return text.starts_with("#?RADI") || text.starts_with("#?RGBE");
}

Image read_hdr(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (error) fail(path, fmt::format("cannot be opened: {}", error.message()));
    if (!fs::is_regular_file(status)) fail(path, "is not a regular file");
    Source source{std::ifstream(path, std::ios::binary), false};
    if (!source.file) fail(path, fmt::format("cannot be opened: {}", std::strerror(errno)));
    const stbi_io_callbacks callbacks = {read_source, skip_source, is_at_end};
    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<float, decltype(&stbi_image_free)> pixels(
        stbi_loadf_from_callbacks(&callbacks, &source, &width, &height, &channels, 3), &stbi_image_free);
    if (!pixels) fail(path, fmt::format("damaged: {}", stbi_failure_reason()));
    if (source.past_end) fail(path, "cut off: the file ends before its pixels do");
    Image image(width, height, 3);
    std::memcpy(image.floats().data(), pixels.get(), image.floats().size_bytes());
    return image;
}

}  // namespace aftershade
