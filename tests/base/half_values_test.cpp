#include "framework/base/half_values.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace aftershade {
namespace {

/// By the format's definition; not for NaN.
float value_of(std::uint16_t half) {
    const int exponent = (half >> 10) & 31, mantissa = half & 1023;
    const double size = exponent == 0    ? std::ldexp(mantissa, -24)
                        : exponent == 31 ? std::numeric_limits<double>::infinity()
                                         : std::ldexp(1024 + mantissa, exponent - 25);
    return float(half & 0x8000 ? -size : size);
}

bool is_nan(std::uint16_t half) {
    return (half & 0x7fff) > 0x7c00;
}

TEST(HalfValues, KeepEveryHalf) {
    if (!converts_halfs()) GTEST_SKIP() << "the processor has no instruction for it";
    std::vector<std::uint16_t> halfs;
    for (int bits = 0; bits < 65536; ++bits)
        if (!is_nan(std::uint16_t(bits))) halfs.push_back(std::uint16_t(bits));
    halfs.resize(halfs.size() / 8 * 8 + 4);  // a tail, too
    std::vector<float> values(halfs.size());
    from_halfs(halfs.data(), values.data(), halfs.size());
    for (std::size_t i = 0; i < halfs.size(); ++i)
        ASSERT_EQ(std::bit_cast<std::uint32_t>(values[i]), std::bit_cast<std::uint32_t>(value_of(halfs[i])));
    std::vector<std::uint16_t> back(halfs.size());
    EXPECT_TRUE(to_exact_halfs(values.data(), back.data(), values.size()));
    EXPECT_EQ(back, halfs);
}

TEST(HalfValues, FindTheOneValueThatIsNone) {
    if (!converts_halfs()) GTEST_SKIP() << "the processor has no instruction for it";
    for (const float other : {0.1F, 65520.0F, 1e-8F, 2049.0F, -1e30F})
        for (std::size_t at = 0; at < 20; ++at) {
            std::vector<float> values(20, 0.25F);
            std::vector<std::uint16_t> halfs(20);
            ASSERT_TRUE(to_exact_halfs(values.data(), halfs.data(), 20));
            values[at] = other;
            EXPECT_FALSE(to_exact_halfs(values.data(), halfs.data(), 20)) << other << " at " << at;
        }
}

}  // namespace
}  // namespace aftershade
