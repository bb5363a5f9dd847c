#include "framework/file/jpeg_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>

#include "framework/base/atomic_file.h"

#define STBI_ONLY_JPEG
#include "framework/file/stb_internal.h"

namespace aftershade {

namespace fs = std::filesystem;
using stb::fail;

namespace {

constexpr std::uintmax_t kMaxJpegBytes = 512u * 1024 * 1024;
// ITU-T T.81, table B.1.
constexpr const char* kStartOfImage = "\xff\xd8\xff";
constexpr const char* kStartOfScan = "\xff\xda";
constexpr const char* kEndOfImage = "\xff\xd9";

}  // namespace

bool is_jpeg_file(const fs::path& path) {
    return file_begins_with(path, kStartOfImage);
}

Image read_jpeg(const fs::path& path) {
    std::string fault;
    const std::string text = read_regular_file(path, kMaxJpegBytes, fault);
    if (!fault.empty()) fail(path, fault);
    return decode_jpeg(path, text);
}

Image decode_jpeg(const fs::path& path, std::string_view text) {
    if (text.size() > kMaxJpegBytes)
        fail(path, fmt::format("has {} bytes, the limit is {}", text.size(), kMaxJpegBytes));
    const auto* bytes = reinterpret_cast<const unsigned char*>(text.data());
    int width = 0, height = 0, channels = 0;
    stb::bytes_left = stb::kMaxImageBytes;
    if (stbi_info_from_memory(bytes, int(text.size()), &width, &height, &channels) == 0)
        fail(path, fmt::format("damaged: {}", stbi_failure_reason()));
    if (const std::string size = stb::fault_of_size(width, height, channels); !size.empty()) fail(path, size);
    const std::size_t scan = text.rfind(kStartOfScan), end = text.rfind(kEndOfImage);
    if (scan == std::string::npos || end == std::string::npos || end < scan)
        fail(path, "cut off: the file ends before its pixels do");
    const std::unique_ptr<unsigned char, decltype(&stbi_image_free)> pixels(
        stbi_load_from_memory(bytes, int(text.size()), &width, &height, &channels, 0), &stbi_image_free);
    if (!pixels) fail(path, fmt::format("damaged: {}", stbi_failure_reason()));
    Image image(width, height, channels);
    const std::span<float> values = image.floats();
    std::transform(pixels.get(), pixels.get() + values.size(), values.begin(),
                   [](unsigned char value) { return float(value) / 255.0f; });
    return image;
}

}  // namespace aftershade
