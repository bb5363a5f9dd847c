#include "framework/image/non_finite.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace aftershade {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

/// Every value another number, so that a mean of the wrong pixels shows.
Image ramp(int width, int height, int channels) {
    Image image(width, height, channels);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) image.at(x, y, c) = float(100 * c + 10 * y + x * x);
    return image;
}

/// The rule of the header in double precision, with nothing shared with the program.
double mean_of(const Image& image, int x, int y, int c, int radius_px) {
    double sum = 0, count = 0;
    for (int v = y - radius_px; v <= y + radius_px; ++v)
        for (int u = x - radius_px; u <= x + radius_px; ++u) {
            if (u < 0 || v < 0 || u >= image.width() || v >= image.height()) continue;
            if (!std::isfinite(image.at(u, v, c))) continue;
            sum += double(image.at(u, v, c));
            count += 1;
        }
    return sum / count;
}

TEST(NonFinite, PixelsAreCountedOnceWhicheverChannelsAreAtFault) {
    Image image = ramp(9, 7, 4);
    EXPECT_FALSE(find_non_finite(image, false));
    image.at(5, 2, 1) = kNan;
    image.at(5, 2, 3) = kInf;
    image.at(1, 3, 0) = -kInf;
    image.at(8, 6, 2) = kNan;
    const NonFinitePixels found = find_non_finite(image, false);
    EXPECT_EQ(found.nan, 2u);
    EXPECT_EQ(found.infinite, 1u);
    EXPECT_EQ(found.x, 5);
    EXPECT_EQ(found.y, 2);
    EXPECT_EQ(found.mended, 0u);
}

TEST(NonFinite, InfiniteDepthIsSoundAndMinusInfinityIsNot) {
    Image depth(4, 4, 1);
    for (float& value : depth.floats()) value = kInf;
    EXPECT_FALSE(find_non_finite(depth, true));
    EXPECT_EQ(find_non_finite(depth, false).infinite, 16u);
    depth.at(3, 1, 0) = -kInf;
    EXPECT_EQ(find_non_finite(depth, true).infinite, 1u);
}

TEST(NonFinite, EveryKindOfValueIsJudgedWhereverItStands) {
    const std::vector<float> sound = {0.0f, -0.0f, 1e-45f, -1e-45f, 3.4028235e38f, -3.4028235e38f, -2.0f};
    const std::vector<float> faults = {kNan,
                                       -kNan,
                                       std::bit_cast<float>(0x7f800001u),
                                       std::bit_cast<float>(0xff800001u),
                                       std::bit_cast<float>(0x7fffffffu),
                                       std::bit_cast<float>(0xffffffffu),
                                       -kInf};
    for (int x = 0; x < 5; ++x) {  // an odd row: the last value stands alone
        for (const float value : faults) {
            Image image(5, 1, 1);
            image.at(x, 0, 0) = value;
            for (const bool infinity_allowed : {false, true})
                EXPECT_EQ(find_non_finite(image, infinity_allowed).count(), 1u) << x << ", " << value;
        }
        for (const float value : sound) {
            Image image(5, 1, 1);
            image.at(x, 0, 0) = value;
            for (const bool infinity_allowed : {false, true})
                EXPECT_FALSE(find_non_finite(image, infinity_allowed)) << x << ", " << value;
        }
        Image image(5, 1, 1);
        for (float& value : image.floats()) value = -1.0f;
        image.at(x, 0, 0) = kInf;
        EXPECT_FALSE(find_non_finite(image, true)) << x;
        EXPECT_EQ(find_non_finite(image, false).infinite, 1u) << x;
    }
}

TEST(NonFinite, ValuesAreFiniteIfNoneIsNanOrInfinite) {
    std::vector<float> values(37, 1.5f);
    EXPECT_TRUE(are_finite(values));
    EXPECT_TRUE(are_finite({}));
    for (std::size_t i = 0; i < values.size(); ++i)
        for (const float fault : {std::nanf(""), kInf, -kInf}) {
            values[i] = fault;
            EXPECT_FALSE(are_finite(values)) << i << " " << fault;
            values[i] = 1.5f;
        }
}

TEST(NonFinite, IntegersHaveNone) {
    Image ids(3, 3, 1, ComponentType::uint32);
    for (std::uint32_t& id : ids.uints()) id = 0x7fc00000;  // the bits of a NaN
    EXPECT_FALSE(find_non_finite(ids, false));
    EXPECT_FALSE(mend_non_finite(ids, false));
}

TEST(NonFinite, ValuesAreMendedByTheMeanOfTheSmallestNeighbourhoodThatHasAny) {
    Image image = ramp(16, 12, 3);
    image.at(0, 0, 2) = kNan;  // a corner: three neighbours
    for (int y = 4; y <= 6; ++y)
        for (int x = 6; x <= 8; ++x) image.at(x, y, 0) = kInf;  // its middle needs 5 x 5
    const Image before = image;
    const NonFinitePixels mended = mend_non_finite(image, false);
    EXPECT_EQ(mended.nan, 1u);
    EXPECT_EQ(mended.infinite, 9u);
    EXPECT_EQ(mended.mended, 10u);
    EXPECT_EQ(mended.zeroed, 0u);
    EXPECT_FALSE(find_non_finite(image, false));
    EXPECT_FLOAT_EQ(image.at(0, 0, 2), float(mean_of(before, 0, 0, 2, 1)));
    EXPECT_FLOAT_EQ(image.at(6, 4, 0), float(mean_of(before, 6, 4, 0, 1)));
    EXPECT_FLOAT_EQ(image.at(7, 5, 0), float(mean_of(before, 7, 5, 0, 2)));
    EXPECT_EQ(image.at(7, 5, 1), before.at(7, 5, 1)) << "a sound channel of that pixel";
}

TEST(NonFinite, PixelsFarFromAnyFiniteOneBecomeZeroAndAreCounted) {
    Image image = ramp(40, 1, 1);
    for (int x = 0; x < 30; ++x) image.at(x, 0, 0) = kNan;
    const NonFinitePixels mended = mend_non_finite(image, false);
    EXPECT_EQ(mended.mended, 30u);
    EXPECT_EQ(mended.zeroed, 27u) << "all but the three within 3 px of a number";
    EXPECT_EQ(image.at(26, 0, 0), 0.0f);
    EXPECT_EQ(image.at(27, 0, 0), 900.0f) << "the mean of the one pixel within 3 px";
}

TEST(NonFinite, SoundValuesKeepTheirBits) {
    Image image = ramp(8, 8, 2);
    image.at(1, 1, 0) = -0.0f;
    image.at(2, 1, 0) = std::numeric_limits<float>::denorm_min();
    image.at(3, 3, 1) = kNan;
    const Image before = image;
    mend_non_finite(image, false);
    for (std::size_t i = 0; i < image.floats().size(); ++i)
        EXPECT_TRUE(!std::isfinite(before.floats()[i]) ||
                    std::memcmp(&image.floats()[i], &before.floats()[i], sizeof(float)) == 0)
            << i;
}

TEST(NonFinite, SeveralThreadsFindWhatOneDoes) {
    Image image = ramp(1000, 700, 3);
    for (const int y : {120, 121, 350, 698}) {  // of the first part of two, of both, and of the last
        image.at(998 - y, y, 1) = kNan;
        image.at(3, y, 2) = kInf;
    }
    const NonFinitePixels one = find_non_finite(image, false), four = find_non_finite(image, false, 4);
    EXPECT_EQ(four.nan, 4u);
    EXPECT_EQ(four.infinite, 4u);
    EXPECT_EQ(four.x, 3);
    EXPECT_EQ(four.y, 120);
    EXPECT_EQ(one.x, four.x);
    EXPECT_EQ(one.y, four.y);
    EXPECT_EQ(mend_non_finite(image, false, 4).mended, 8u);
    EXPECT_FALSE(find_non_finite(image, false, 4));
}

}  // namespace
}  // namespace aftershade
