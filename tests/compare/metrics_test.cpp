#include "framework/compare/metrics.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace aftershade {
namespace {

Image grey(double value) {
    Image image(4, 3, 3);
    for (float& v : image.floats()) v = float(value);
    return image;
}

TEST(DisplayPsnr, EncodesByThePiecewiseSrgbCurve) {
    EXPECT_NEAR(srgb_of_clamped(0.002), 0.02584, 1e-12);
    EXPECT_NEAR(srgb_of_clamped(0.5), 0.7353569830524495, 1e-12);  // IEC 61966-2-1, double precision
    EXPECT_EQ(srgb_of_clamped(7), 1);
    EXPECT_EQ(srgb_of_clamped(-1), 0);
    EXPECT_EQ(srgb_of_clamped(std::numeric_limits<double>::quiet_NaN()), 0);
    const double difference = 0.7353569830524495 - 0.5370987304831942;  // of 0.5 and 0.25
    EXPECT_NEAR(display_psnr_db(grey(0.5), grey(0.25)), -20 * std::log10(difference), 1e-9);
}

TEST(DisplayPsnr, IgnoresWhatADisplayCannotShow) {
    EXPECT_TRUE(std::isinf(display_psnr_db(grey(1), grey(50))));
    EXPECT_TRUE(std::isinf(display_psnr_db(grey(0), grey(-3))));
}

}  // namespace
}  // namespace aftershade
