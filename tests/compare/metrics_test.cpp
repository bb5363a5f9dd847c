#include "framework/compare/metrics.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/not_finite.h"

namespace aftershade {
namespace {

using test::kInfinity;
using test::kNan;

Image row(std::initializer_list<float> values) {
    Image image(int(values.size()), 1, 1);
    std::copy(values.begin(), values.end(), image.floats().begin());
    return image;
}

Image grey(double value) {
    Image image(4, 3, 3);
    for (float& v : image.floats()) v = float(value);
    return image;
}

TEST(Metrics, OfEqualImagesAreZeroAndInfinite) {
    const ImageMetrics metrics = compare_images(row({1, 2, 3}), row({1, 2, 3}), 1);
    EXPECT_EQ(metrics.mean_absolute, 0);
    EXPECT_EQ(metrics.rmse, 0);
    EXPECT_EQ(metrics.max.value, 0);
    EXPECT_TRUE(std::isinf(metrics.psnr_db) && metrics.psnr_db > 0);
}

TEST(Metrics, FollowTheirDefinitions) {
    // Differences 0, 0.3, -0.4: mean 0.7 / 3, squares 0.25 / 3.
    const ImageMetrics metrics = compare_images(row({1, 0.5f, 0.5f}), row({1, 0.8f, 0.1f}), 1);
    EXPECT_NEAR(metrics.mean_absolute, 0.7 / 3, 1e-7);
    EXPECT_NEAR(metrics.rmse, std::sqrt(0.25 / 3), 1e-7);
    EXPECT_NEAR(metrics.psnr_db, 10 * std::log10(3 / 0.25), 1e-5);
    EXPECT_NEAR(metrics.max.value, 0.4, 1e-7);
    EXPECT_EQ(metrics.max.x, 2);
}

TEST(Metrics, NameThePlaceOfTheLargestDifference) {
    Image reference(5, 4, 3), test(5, 4, 3);
    test.at(3, 2, 1) = -7;
    const ImageMetrics metrics = compare_images(reference, test, 3);
    EXPECT_EQ(metrics.max.value, 7);
    EXPECT_EQ(metrics.max.x, 3);
    EXPECT_EQ(metrics.max.y, 2);
    EXPECT_EQ(metrics.max.channel, 1);
}

TEST(Metrics, DoNotTakeNanForAMatchUnlessAsked) {
    EXPECT_TRUE(std::isinf(compare_images(row({kNan}), row({kNan}), 1).max.value));
    EXPECT_TRUE(std::isinf(compare_images(row({kNan}), row({1}), 1, true).max.value));
    EXPECT_EQ(compare_images(row({kNan, kInfinity}), row({kNan, kInfinity}), 1, true).max.value, 0);
    EXPECT_TRUE(std::isinf(compare_images(row({kInfinity}), row({-kInfinity}), 1, true).max.value));
    EXPECT_EQ(compare_images(row({kNan}), row({1}), 1).psnr_db, -std::numeric_limits<double>::infinity());
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
