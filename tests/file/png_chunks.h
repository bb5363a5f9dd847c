// PNGs with further chunks.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>

namespace aftershade::test {

/// As PNG stores it.
inline std::string png_number(std::uint32_t value) {
    return {char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
}

/// `png` with a chunk behind its first.
inline std::string png_with_chunk(std::string png, const std::string& type, const std::string& data) {
    constexpr std::size_t kBehindHead = 8 + 25;
    const std::string checked = type + data;
    const auto sum =
        std::uint32_t(crc32(0, reinterpret_cast<const Bytef*>(checked.data()), uInt(checked.size())));
    return png.insert(kBehindHead, png_number(std::uint32_t(data.size())) + checked + png_number(sum));
}

}  // namespace aftershade::test
