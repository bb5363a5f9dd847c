#include "framework/file/png_file.h"

#include "framework/core/atomic_file.h"
#include "framework/core/error.h"
#include "framework/core/memory_limit.h"
#include "framework/file/output_stream.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <exception>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#define STBI_ONLY_PNG
#include "framework/file/stb_internal.h"

namespace aftershade {

namespace fs = std::filesystem;
using stb::fail;

namespace {

constexpr std::uintmax_t kMaxPngBytes = 512u * 1024 * 1024;
constexpr int kMaxSidePx = STBI_MAX_DIMENSIONS;

std::uint8_t to_byte(float value) {
    // The comparison is false for NaN.
    if (!(value > 0.0f)) return 0;
    return static_cast<std::uint8_t>(std::lround(255.0f * std::min(value, 1.0f)));
}

/// stb is written in C: an exception must not pass through it, so the failure is kept until it has returned.
struct Sink {
    OutputStream& stream;
    std::exception_ptr failure;
};

void write_to_sink(void* context, void* bytes, int count) {
    Sink& sink = *static_cast<Sink*>(context);
    if (sink.failure) return;
    try {
        sink.stream.write(bytes, std::size_t(count));
    } catch (...) {
        sink.failure = std::current_exception();
    }
}

std::string read_bytes(const fs::path& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) fail(path, "is a folder, not a PNG file");
    std::string fault;
    std::string bytes = read_regular_file(path, kMaxPngBytes, fault);
    if (!fault.empty()) fail(path, fault);
    if (bytes.empty()) fail(path, "the file is empty");
    return bytes;
}

/// stb_image passes over the checksums of chunks and of the pixels: what it takes from a damaged file would
/// be another picture. Chunks as the PNG specification, section 5.3, has them; of those that may be ignored
/// nothing is asked.
void check_chunks(const fs::path& path, std::span<const unsigned char> bytes) {
    const auto number_at = [&](std::size_t at) {
        return std::uint32_t(bytes[at]) << 24 | std::uint32_t(bytes[at + 1]) << 16 |
               std::uint32_t(bytes[at + 2]) << 8 | std::uint32_t(bytes[at + 3]);
    };
    constexpr std::size_t kSignature = 8, kHead = 8, kChecksum = 4;
    for (std::size_t at = kSignature; at + kHead + kChecksum <= bytes.size();) {
        const std::size_t length = number_at(at);
        const std::string type(bytes.begin() + std::ptrdiff_t(at) + 4,
                               bytes.begin() + std::ptrdiff_t(at) + 8);
        if (length > bytes.size() - at - kHead - kChecksum) break;
        const auto checksum = std::uint32_t(crc32(0, &bytes[at + 4], uInt(4 + length)));
        const bool is_critical = type[0] >= 'A' && type[0] <= 'Z';
        if (is_critical && checksum != number_at(at + kHead + length))
            fail(path, fmt::format("damaged: the chunk {} at byte {} has another checksum than its bytes",
                                   type, at));
        if (type == "IEND") return;
        at += kHead + length + kChecksum;
    }
    fail(path, fmt::format("damaged: cut off, {} bytes do not reach its last chunk", bytes.size()));
}

}  // namespace

void write_png(const fs::path& path, const Image& display) {
    const int channels = display.channels();
    assert(channels == 1 || channels == 3 || channels == 4);
    assert(!display.empty());
    if (display.width() > kMaxSidePx || display.height() > kMaxSidePx) {
        throw Error(ExitCode::output,
                    fmt::format("{}: {} x {} px is too large for PNG output, the limit is {} px a side",
                                path.string(), display.width(), display.height(), kMaxSidePx));
    }
    const std::span<const float> values = display.floats();
    std::vector<std::uint8_t> bytes(values.size());
    std::ranges::transform(values, bytes.begin(), to_byte);

    OutputStream stream(path);
    Sink sink{stream, nullptr};
    const int written = stbi_write_png_to_func(write_to_sink, &sink, display.width(), display.height(),
                                               channels, bytes.data(), display.width() * channels);
    if (sink.failure) std::rethrow_exception(sink.failure);
    if (written == 0)
        throw Error(ExitCode::memory, path.string() + ": " + out_of_memory_text(std::bad_alloc()));
    stream.commit();
}

Image read_png(const fs::path& path) {
    const std::string text = read_bytes(path);
    const std::span bytes(reinterpret_cast<const unsigned char*>(text.data()), text.size());
    const int size = static_cast<int>(bytes.size());
    int width = 0, height = 0, channels = 0;
    stb::bytes_left = stb::kMaxImageBytes;
    if (stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0) {
        fail(path, fmt::format("not a PNG file that can be read: {}", stbi_failure_reason()));
    }
    if (width > kMaxSidePx || height > kMaxSidePx) {
        fail(path, fmt::format("{} x {} px, the limit is {} px a side", width, height, kMaxSidePx));
    }
    if (const std::string fault = stb::fault_of_size(width, height, channels); !fault.empty())
        fail(path, fault);
    check_chunks(path, bytes);
    const bool is_wide = stbi_is_16_bit_from_memory(bytes.data(), size) != 0;
    const auto load = [&](auto* from_memory, float maximum) {
        const auto loaded = from_memory(bytes.data(), size, &width, &height, &channels, 0);
        const std::unique_ptr<std::remove_pointer_t<decltype(loaded)>, decltype(&stbi_image_free)> pixels(
            loaded, &stbi_image_free);
        if (!pixels) fail(path, fmt::format("damaged: {}", stbi_failure_reason()));
        Image image(width, height, channels);
        const std::span<float> values = image.floats();
        std::transform(pixels.get(), pixels.get() + values.size(), values.begin(),
                       [&](auto value) { return static_cast<float>(value) / maximum; });
        return image;
    };
    return is_wide ? load(&stbi_load_16_from_memory, 65535.0f) : load(&stbi_load_from_memory, 255.0f);
}

}  // namespace aftershade
