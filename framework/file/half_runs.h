// Floats to halfs, a run at a time: without a branch where all are ordinary, else as Imath does it.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Imath/half.h>

namespace aftershade::exr {

inline constexpr std::size_t kHalfRun = 64;

/// Rounded to the nearest half, ties to even, by the additions of Fabian Giesen's "float->half variants": one
/// carries out of the bits that a normal half lacks, the other lines a subnormal one up with the last bit of
/// 0.5. False where a value is beyond 65504, infinite or NaN; `halfs` is then undefined.
inline bool to_plain_halfs(const std::array<float, kHalfRun>& values,
                           std::array<std::uint16_t, kHalfRun>& halfs) {
    constexpr std::int32_t kMagnitude = 0x7fffffff, kLargest = 0x477fe000, kSmallestNormal = 0x38800000;
    constexpr std::int32_t kHalfBits = 0x3f000000;         // of 0.5F
    constexpr std::int32_t kExponents = (127 - 15) << 23;  // between the biases of the two formats
    std::int32_t beyond = 0;
    for (std::size_t i = 0; i < kHalfRun; ++i) {
        const auto bits = std::bit_cast<std::int32_t>(values[i]);
        const std::int32_t size = bits & kMagnitude;
        beyond |= kLargest - size;
        const std::int32_t normal = (size - kExponents + 0xfff + ((size >> 13) & 1)) >> 13;
        const std::int32_t subnormal =
            std::bit_cast<std::int32_t>(std::bit_cast<float>(size) + 0.5F) - kHalfBits;
        const std::int32_t magnitude = size < kSmallestNormal ? subnormal : normal;
        halfs[i] = std::uint16_t(magnitude | ((bits >> 16) & 0x8000));
    }
    return beyond >= 0;
}

/// Returns how many finite values became infinite.
inline std::size_t to_halfs(std::span<const float> values, std::array<std::uint16_t, kHalfRun>& halfs) {
    std::size_t overflows = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Imath::half value(values[i]);
        if (value.isInfinity() && std::isfinite(values[i])) ++overflows;
        halfs[i] = value.bits();
    }
    return overflows;
}

}  // namespace aftershade::exr
