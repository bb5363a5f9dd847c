#include "framework/batch/page_pixels.h"

#include <Imath/half.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace aftershade {

namespace {

bool is_half(float value) {
    return std::isnan(value) || float(Imath::half(value)) == value;
}

/// Planes as page_pixels() says, of `bytes` bytes each value.
template <class BitsAt>
std::vector<Bytef> planes_of(const Image& image, int bytes, BitsAt bits_at) {
    const std::size_t channels = std::size_t(image.channels());
    const std::size_t pixels = std::size_t(image.width()) * std::size_t(image.height());
    std::vector<Bytef> planes;
    planes.reserve(pixels * channels * std::size_t(bytes));
    for (std::size_t channel = 0; channel < channels; ++channel)
        for (int shift = 0; shift < 8 * bytes; shift += 8) {
            std::uint32_t before = 0;
            for (std::size_t i = 0; i < pixels; ++i) {
                const std::uint32_t byte = bits_at(i * channels + channel) >> shift & 255u;
                planes.push_back(Bytef(byte - before));
                before = byte;
            }
        }
    return planes;
}

std::string deflated(const std::vector<Bytef>& bytes) {
    uLongf size = compressBound(uLong(bytes.size()));
    std::vector<std::byte> stream(size);
    // It fails only where memory runs out.
    if (compress2(reinterpret_cast<Bytef*>(stream.data()), &size, bytes.data(), uLong(bytes.size()),
                  Z_DEFAULT_COMPRESSION) != Z_OK)
        throw std::runtime_error("zlib has no memory left");
    stream.resize(size);
    return base64(stream);
}

}  // namespace

// No library that this project uses has it in its public headers.
std::string base64(std::span<const std::byte> bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < count; ++k)
            group |= std::to_integer<std::uint32_t>(bytes[i + k]) << (16 - 8 * k);
        for (std::size_t k = 0; k < 4; ++k) text += k <= count ? digits[group >> (18 - 6 * k) & 63u] : '=';
    }
    return text;
}

PagePixels page_pixels(const Image& image) {
    if (image.type() == ComponentType::uint32)
        return {"uint", deflated(planes_of(image, 4, [&](std::size_t i) { return image.uints()[i]; }))};
    const auto values = image.floats();
    if (std::ranges::all_of(values, is_half))
        return {"half", deflated(planes_of(image, 2, [&](std::size_t i) {
                    return std::uint32_t(Imath::half(values[i]).bits());
                }))};
    return {"float", deflated(planes_of(
                         image, 4, [&](std::size_t i) { return std::bit_cast<std::uint32_t>(values[i]); }))};
}

}  // namespace aftershade
