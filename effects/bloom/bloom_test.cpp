// The glow of a point: its energy, its centre and its width against closed forms, and faults that must not
// spread.
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "tests/backends.h"
#include "tests/look_runner.h"
#include "tests/synthetic_capture.h"
#include "tests/wide_capture.h"

namespace aftershade::test::bloom {
namespace {

Image bloomed(const Capture& capture, const std::string& params) {
    return run_step("bloom", capture, params).images.at("color");
}

/// Sum, mean place and variance along x and y of one channel as a distribution of light, px.
struct Moments {
    double sum = 0, x = 0, y = 0, variance_x = 0, variance_y = 0;
};

Moments moments_of(const Image& image, int channel) {
    Moments m;
    double xx = 0, yy = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const double light = image.at(x, y, channel);
            m.sum += light;
            m.x += light * x;
            m.y += light * y;
            xx += light * x * x;
            yy += light * y * y;
        }
    m.x /= m.sum;
    m.y /= m.sum;
    m.variance_x = xx / m.sum - m.x * m.x;
    m.variance_y = yy / m.sum - m.y * m.y;
    return m;
}

Capture point(int x, int y, float intensity, int width = 256, int height = 256) {
    return make_capture({.width = width, .height = height, .points = {{x, y, intensity}}});
}

TEST(Bloom, KeepsTheEnergyOfAPointWithinATenthOfAPercent) {
    for (const float intensity : {0.1f, 0.5f, 1.0f}) {
        const std::string params =
            R"("fireflies": "keep", "radius": 10, "intensity": )" + std::to_string(intensity);
        EXPECT_NEAR(moments_of(bloomed(point(131, 122, 1e4f), params), 0).sum, 1e4, 10) << intensity;
    }
}

TEST(Bloom, ScattersAroundThePointWhereverItLiesOnThePyramid) {
    for (const int shift : {0, 1, 2, 3, 5, 7}) {
        const Moments m =
            moments_of(bloomed(point(124 + shift, 130 - shift, 100),
                               R"("fireflies": "keep", "radius": 8, "scatter": 1, "intensity": 1)"),
                       0);
        EXPECT_NEAR(m.x, 124 + shift, 0.01) << shift;
        EXPECT_NEAR(m.y, 130 - shift, 0.01) << shift;
    }
}

/// Down to level n and up again adds 1.5 (4^n - 1) px squared, which is what radius asks for at scatter 1.
TEST(Bloom, RadiusIsTheStandardDeviationOfTheWidestBlur) {
    for (const int level : {1, 2, 3}) {
        const double radius = std::sqrt(1.5 * (std::pow(4, level) - 1));
        const Image out =
            bloomed(point(128, 127, 100), R"("fireflies": "keep", "scatter": 1, "intensity": 1, "radius": )" +
                                              std::to_string(radius));
        const Moments m = moments_of(out, 1);
        EXPECT_NEAR(std::sqrt(m.variance_x), radius, 0.03 * radius) << level;
        EXPECT_NEAR(std::sqrt(m.variance_y), radius, 0.03 * radius) << level;
    }
}

/// What effect.json declares as its reach: level n of the pyramid is read up to 2^n < 1.64 radius + 2, and
/// each of its texels within 6 times 2^n px.
TEST(Bloom, GivesNoLightToPixelsBeyondTenTimesItsRadius) {
    for (const int radius : {1, 5, 20}) {
        const std::string params = R"("fireflies": "keep", "scatter": 1, "intensity": 1, "radius": )";
        LookRunner runner(look_of_step("bloom", params + std::to_string(radius)), gpu::test_backend());
        for (const int x : {383, 384, 389, 511, 512}) {
            const Image image = runner.color(point(x, 7, 1e6f, 896, 16));
            const int reach = 10 * radius + 12;
            EXPECT_GT(image.at(x + radius, 7, 0), 0) << radius << ", " << x;
            for (int y = 0; y < 16; ++y)
                for (int there = 0; there < 896; ++there) {
                    if (std::abs(there - x) <= reach) continue;
                    ASSERT_EQ(image.at(there, y, 0), 0) << radius << ", " << x;
                }
        }
    }
}

TEST(Bloom, IsTheMirrorImageOfTheMirrorImagesBloom) {
    Capture capture = make_capture({.width = 64, .height = 64}), mirrored = capture;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 3; ++c)
                mirrored.images["color"].at(63 - x, y, c) = capture.images["color"].at(x, y, c) =
                    float((x * 7 + y * 13 + c) % 11) * (x == 20 ? 100.0f : 1.0f);
    const Image a = bloomed(capture, R"("intensity": 0.5)"), b = bloomed(mirrored, R"("intensity": 0.5)");
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            ASSERT_NEAR(a.at(x, y, 0), b.at(63 - x, y, 0), 1e-4 * (1 + a.at(x, y, 0)));
}

TEST(Bloom, LeavesAFlatPictureAndItsCoverageFlat) {
    const Capture capture =
        make_capture({.width = 50, .height = 30, .background = {0.5f, 0.25f, 4}, .alpha = 0.5f});
    const Image out = bloomed(capture, R"("intensity": 0.7)");
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 50; ++x) {
            ASSERT_NEAR(out.at(x, y, 0), 0.25, 1e-5);
            ASSERT_NEAR(out.at(x, y, 2), 2, 1e-5);
            ASSERT_NEAR(out.at(x, y, 3), 0.5, 1e-5);
        }
}

TEST(Bloom, SoftensAFireflyButNotALargeLight) {
    const std::string params = R"("radius": 4, "intensity": 1, "fireflies": )";
    const double kept = moments_of(bloomed(point(64, 64, 1000, 128, 128), params + R"("keep")"), 0).sum;
    const double soft = moments_of(bloomed(point(64, 64, 1000, 128, 128), params + R"("soften")"), 0).sum;
    EXPECT_LT(soft, 0.02 * kept);
    const SyntheticBox box{.x = 48, .y = 48, .width = 32, .height = 32, .color = {1000, 1000, 1000}};
    const Capture large = make_capture({.width = 128, .height = 128, .box = box}, 0);
    EXPECT_GT(moments_of(bloomed(large, params + R"("soften")"), 0).sum, 0.85 * 32 * 32 * 1000);
}

TEST(Bloom, ScattersOnlyLightAboveTheThreshold) {
    const std::string params =
        R"("fireflies": "keep", "intensity": 1, "radius": 4, "threshold": 2, "knee": 0)";
    const Image below = bloomed(point(32, 32, 1.9f, 64, 64), params);
    EXPECT_EQ(below.at(32, 32, 0), 1.9f);
    EXPECT_EQ(below.at(33, 32, 0), 0);
    // Of 10, the 8 above the threshold leave; a little of them comes back.
    const Image above = bloomed(point(32, 32, 10, 64, 64), params);
    EXPECT_NEAR(above.at(32, 32, 0), 2, 0.5);
    EXPECT_NEAR(moments_of(above, 0).sum, 10, 0.01);
}

TEST(Bloom, SpreadsNoFault) {
    Capture capture = make_capture({.width = 64, .height = 64, .background = {0.5f, 0.5f, 0.5f}});
    capture.images["color"].at(20, 20, 0) = std::numeric_limits<float>::quiet_NaN();
    capture.images["color"].at(40, 40, 1) = std::numeric_limits<float>::infinity();
    const Image out = bloomed(capture, R"("intensity": 0.5)");
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 3; ++c) {
                if ((x == 20 && y == 20) || (x == 40 && y == 40)) continue;
                ASSERT_NEAR(out.at(x, y, c), 0.5, 0.05) << x << " " << y;
            }
}

/// Fireflies are softened by their luminance, which is no sum of one space's numbers by another's weights.
TEST(Bloom, GivesTheSameLightOfCapturesInWiderPrimaries) {
    Capture capture = point(31, 30, 40, 64, 64);
    capture.images.at("color").at(31, 30, 2) = 400;
    capture.images.at("color").at(40, 20, 0) = 300;
    const std::string params = R"("fireflies": "soften", "threshold": 0, "intensity": 0.5)";
    const Image expected = bloomed(capture, params);
    for (const char* space : {"rec2020", "acescg"})
        EXPECT_LT(largest_share(in_rec709(bloomed(in_space(capture, space), params), space), expected), 1e-3)
            << space;
}

}  // namespace
}  // namespace aftershade::test::bloom
