// The falloff against its closed form, and crops against the whole.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/crop.h"
#include "tests/look_runner.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test::vignette {
namespace {

Image vignetted(const Capture& capture, const std::string& params) {
    return run_step("vignette", capture, params).images.at("color");
}

Capture white() {
    return make_capture({.background = {1, 1, 1}});
}

TEST(Vignette, NaturalIsCosToTheFourthOfTheFieldAngle) {
    const Image out = vignetted(white(), R"("strength": 0, "focal_length": 20, "sensor_width": 36)");
    for (int y = 0; y < 36; ++y)
        for (int x = 0; x < 64; ++x) {
            const double off_axis_mm = std::hypot(x + 0.5 - 32, y + 0.5 - 18) * 36 / 64;
            ASSERT_NEAR(out.at(x, y, 1), std::pow(std::cos(std::atan(off_axis_mm / 20)), 4), 1e-6);
            ASSERT_EQ(out.at(x, y, 3), 1);
        }
}

TEST(Vignette, TakesTheLensFromTheCapturesCamera) {
    Capture capture = white();
    capture.header.camera.set("focal_length", 20);
    capture.header.camera.set("sensor_width", 36);
    const Image told = vignetted(white(), R"("strength": 0, "focal_length": 20, "sensor_width": 36)");
    EXPECT_TRUE(same_in_window(told, vignetted(capture, R"("strength": 0)"), {0, 0, 63, 35}));
}

TEST(Vignette, TheArtisticOneReachesHalfItsStrengthAtRadius) {
    // Along the row of the centre the ellipse is 1 at sqrt(2) times half the width: x = 32 + 0.5 * 45.25
    // = 54.6.
    const Image out = vignetted(
        white(), R"("natural": 0, "strength": 0.8, "radius": 0.5, "roundness": 0, "softness": 0.2)");
    EXPECT_NEAR(0.5 * (out.at(54, 18, 0) + out.at(54, 17, 0)), 0.6, 0.03);
    EXPECT_EQ(out.at(32, 18, 0), 1);
    EXPECT_NEAR(out.at(0, 0, 0), 0.2, 1e-6);
    // A circle of half the half-diagonal, 18.36 px.
    const Image circle =
        vignetted(white(), R"("natural": 0, "strength": 1, "radius": 0.5, "roundness": 1, "softness": 0)");
    for (int y = 0; y < 36; ++y)
        for (int x = 0; x < 64; ++x) {
            const double away_px = std::hypot(x + 0.5 - 32, y + 0.5 - 18);
            if (std::abs(away_px - 0.25 * std::hypot(64, 36)) < 0.01) continue;
            ASSERT_EQ(circle.at(x, y, 0), away_px < 0.25 * std::hypot(64, 36) ? 1 : 0) << x << " " << y;
        }
}

TEST(Vignette, ACropHasThePixelsOfTheWhole) {
    const Window window{30, 3, 60, 33};
    EXPECT_TRUE(same_in_window(vignetted(white(), ""), vignetted(cropped(white(), window), ""), window));
}

TEST(Vignette, OverscanLeavesThePixelsOfTheDisplayWindowAsTheyAre) {
    Capture overscan = make_capture({.width = 80, .height = 48, .background = {1, 1, 1}});
    overscan.header.data_window = {-8, -6, 71, 41};
    overscan.header.display_window = {0, 0, 63, 35};
    const Image out = vignetted(overscan, ""), plain = vignetted(white(), "");
    EXPECT_TRUE(same_in_window(out, plain, {8, 6, 71, 41}));
    // Beyond the corner the falloff goes on.
    EXPECT_LT(out.at(0, 0, 0), plain.at(0, 0, 0));
}

}  // namespace
}  // namespace aftershade::test::vignette
