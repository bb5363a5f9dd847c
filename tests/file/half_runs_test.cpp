#include "framework/file/half_runs.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace aftershade::exr {
namespace {

/// Compares runs with Imath's halfs, one value at a time. What is beyond halfs, or no number, has a run of
/// its own: else it would hide its neighbours.
class Comparison {
public:
    void add(float value) {
        const Imath::half expected(value);
        if (!(std::abs(value) <= 65504)) {
            std::array<float, kHalfRun> values = {};
            values[7] = value;
            EXPECT_FALSE(to_plain_halfs(values, halfs_)) << value;
            return;
        }
        values_[count_] = value;
        expected_[count_] = expected.bits();
        if (++count_ == kHalfRun) finish();
    }
    void finish() {
        EXPECT_TRUE(to_plain_halfs(values_, halfs_));
        for (std::size_t i = 0; i < count_; ++i)
            if (halfs_[i] != expected_[i] && ++faults_ < 10)
                ADD_FAILURE() << std::hexfloat << values_[i] << std::hex << ": " << halfs_[i] << ", not "
                              << expected_[i];
        count_ = 0;
    }

private:
    std::array<float, kHalfRun> values_ = {};
    std::array<std::uint16_t, kHalfRun> expected_ = {}, halfs_ = {};
    std::size_t count_ = 0;
    int faults_ = 0;
};

/// A normal half keeps the first ten bits of a float's mantissa, so how it is rounded depends on the thirteen
/// others alone.
TEST(PlainHalfs, AreThoseOfImathAroundEveryNormalHalf) {
    Comparison comparison;
    for (std::uint32_t kept = 0; kept < (1u << 19); ++kept)
        for (const std::uint32_t rest : {0x0000u, 0x0001u, 0x0fffu, 0x1000u, 0x1001u, 0x1fffu})
            comparison.add(std::bit_cast<float>(kept << 13 | rest));
    comparison.finish();
}

TEST(PlainHalfs, AreThoseOfImathAroundEverySubnormalHalfAndEveryTieOfTwo) {
    Comparison comparison;
    for (int halves = 0; halves <= 2 * 1026; ++halves) {  // of the smallest half, 2^-24
        const float tie = std::ldexp(float(halves), -25);
        for (const float value : {tie, std::nextafter(tie, 1.0F), std::nextafter(tie, -1.0F)}) {
            comparison.add(value);
            comparison.add(-value);
        }
    }
    comparison.finish();
}

TEST(PlainHalfs, LeaveTheLargestValuesAndWhatIsNoNumberToImath) {
    std::array<std::uint16_t, kHalfRun> halfs = {};
    const float inf = std::numeric_limits<float>::infinity();
    for (const float value : {65504.0F, -65504.0F, 65503.9F}) {
        std::array<float, kHalfRun> values = {};
        values.back() = value;
        EXPECT_TRUE(to_plain_halfs(values, halfs)) << value;
        EXPECT_EQ(halfs.back(), Imath::half(value).bits());
    }
    for (const float value : {65504.01F, 65520.0F, -65536.0F, 1e30F, inf, -inf, std::nanf("")}) {
        std::array<float, kHalfRun> values = {};
        values.back() = value;
        EXPECT_FALSE(to_plain_halfs(values, halfs)) << value;
    }
    const std::vector<float> values = {65519.9F, 65520.0F, -1e9F, inf, std::nanf(""), 1.0F};
    EXPECT_EQ(to_halfs(values, halfs), 2u);
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(halfs[i], Imath::half(values[i]).bits());
}

}  // namespace
}  // namespace aftershade::exr
