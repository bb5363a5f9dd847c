#include "framework/serve/quick_png.h"

#include <zlib.h>

#include <array>
#include <cstdint>
#include <new>
#include <string_view>
#include <vector>

#include "framework/file/quantized.h"

namespace aftershade::serve {

namespace {

std::string big_endian(std::uint32_t value) {
    return {char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
}

std::string chunk(std::string_view type, std::string_view data) {
    std::string bytes(type);
    bytes += data;
    const auto checksum =
        std::uint32_t(crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), uInt(bytes.size())));
    return big_endian(std::uint32_t(data.size())) + bytes + big_endian(checksum);
}

/// Each byte less the one above it, which smooth pictures make small.
std::vector<std::uint8_t> filtered_rows(const Image& display) {
    constexpr std::uint8_t kUp = 2;
    const std::size_t stride = std::size_t(display.width()) * std::size_t(display.channels());
    std::vector<std::uint8_t> above(stride), row(stride), rows;
    rows.reserve((stride + 1) * std::size_t(display.height()));
    for (int y = 0; y < display.height(); ++y) {
        const auto values = display.floats().subspan(std::size_t(y) * stride, stride);
        rows.push_back(kUp);
        for (std::size_t i = 0; i < stride; ++i) {
            row[i] = quantized<std::uint8_t>(values[i]);
            rows.push_back(std::uint8_t(row[i] - above[i]));
        }
        above.swap(row);
    }
    return rows;
}

}  // namespace

std::string quick_png(const Image& display, bool is_srgb) {
    const std::vector<std::uint8_t> rows = filtered_rows(display);
    uLongf size = compressBound(uLong(rows.size()));
    std::string packed(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size, rows.data(), uLong(rows.size()),
                  Z_BEST_SPEED) != Z_OK)
        throw std::bad_alloc();
    packed.resize(size);
    constexpr std::array<char, 5> kColorTypes = {0, 0, 4, 2, 6};  // of PNG, by channels
    const std::string head = big_endian(std::uint32_t(display.width())) +
                             big_endian(std::uint32_t(display.height())) + '\x08' +
                             kColorTypes[std::size_t(display.channels())] + std::string(3, '\0');
    const std::string_view perceptual("\0", 1);  // the rendering intent
    return std::string("\x89PNG\r\n\x1a\n") + chunk("IHDR", head) +
           (is_srgb ? chunk("sRGB", perceptual) : "") + chunk("IDAT", packed) + chunk("IEND", "");
}

}  // namespace aftershade::serve
