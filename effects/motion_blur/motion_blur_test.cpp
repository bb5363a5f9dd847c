// What motion_blur must do against renderers' own shutters, with hostile input and on the other backend.
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "effects/motion_blur/motion_blur_test.h"
#include "tests/real_captures.h"

namespace aftershade::test::motion_blur {
namespace {

TEST(MotionBlur, OnSuzanneIsNearHerRenderersShutterAndByDefaultTheNearestOfItsMethods) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "suzanne");
    const SuzanneInMotion suzanne(*folder);
    const auto sharp = suzanne.psnr(suzanne.capture.images.at("color"));
    EXPECT_NEAR(sharp.changed_db, 22.98, 0.05);
    const auto standard = suzanne.through("motion_blur");
    EXPECT_GE(standard.changed_db, 30);
    EXPECT_GE(standard.all_db, sharp.all_db + 2);
    for (const char* method : {"jimenez_2014", "guertin_2014", "mcguire_2012"}) {
        const auto other = suzanne.through("motion_blur", fmt::format(R"("method": "{}")", method));
        EXPECT_LT(other.changed_db, standard.changed_db) << method;
        EXPECT_GT(other.changed_db, sharp.changed_db + 3) << method;
        EXPECT_GE(other.all_db, sharp.all_db) << method;
    }
    EXPECT_GE(suzanne.through("motion_blur", R"("background": "neighbours")").changed_db,
              standard.changed_db + 0.5);
}

TEST(MotionBlur, FollowsTheArcsOfAWheel) {
    const ShutterScene wheel("wheel", 7, 480, 270);
    const double curved = wheel.psnr_db(blur(wheel.capture));
    const double straight = wheel.psnr_db(blur(wheel.capture, R"("curve": false)"));
    fmt::print("wheel: {:.2f} dB, without curves {:.2f}\n", curved, straight);
    EXPECT_GE(curved, straight + 3);
    EXPECT_GE(curved, 30);
}

/// Rims of what rolls and spins move otherwise than their middle; lights at rest stand before and behind what
/// is fast.
TEST(MotionBlur, SoftensRimsAndLeavesLightsAtRestAlone) {
    const ShutterScene toys("toys", 4, 240, 135);
    const double db = toys.psnr_db(blur(toys.capture));
    fmt::print("toys: {:.2f} dB\n", db);
    EXPECT_GE(db, 35.2);  // measured 35.7
}

TEST(MotionBlur, OfAMovingCameraIsNearTheTruth) {
    const ShutterScene checker("camera_checker", 7, 480, 270);
    const double db = checker.psnr_db(blur(checker.capture));
    fmt::print("camera_checker: {:.2f} dB\n", db);
    EXPECT_GE(db, 35);
}

/// How much of each pixel of a row the box covers, by its red against that of the bare wall.
std::vector<double> coverage_of_row(const Image& picture, const Image& wall, double box_red, int y) {
    std::vector<double> coverage;
    for (int x = 0; x < picture.width(); ++x)
        coverage.push_back((picture.at(x, y, 0) - wall.at(x, y, 0)) / (box_red - wall.at(x, y, 0)));
    return coverage;
}

/// Where the coverage passes a value between `from` and `to`, px from the left edge of the picture.
double crossing(const std::vector<double>& coverage, double value, int from, int to) {
    for (int x = from; x < to; ++x) {
        const double a = coverage[std::size_t(x)], b = coverage[std::size_t(x) + 1];
        if ((a - value) * (b - value) <= 0 && a != b) return x + 0.5 + (value - a) / (b - a);
    }
    return -1;
}

class MovingBox : public testing::TestWithParam<const char*> {};

TEST_P(MovingBox, IsATrapezoidOfTheShuttersLength) {
    const int frame = 7, row = 135, width = 480;
    const ShutterScene scene("moving_box", frame, width, 270, 512);
    const Image wall =
        scene::SceneRenderer(scene.source, width, 270, 2).render_capture(16).images.at("color");
    const Image blurred = blur(scene.capture, GetParam());
    const double speed_px = scene.capture.images.at("velocity").at(230, row, 0);
    ASSERT_NEAR(speed_px, 0.1 / 3.9 * width, 0.01);
    const auto measured = coverage_of_row(blurred, wall, 0.8, row),
               truth = coverage_of_row(scene.truth, wall, 0.8, row);
    double sum = 0, true_sum = 0;
    for (int x = 150; x < 300; ++x) sum += measured[std::size_t(x)], true_sum += truth[std::size_t(x)];
    EXPECT_NEAR(sum / true_sum, 1, 0.02);
    const double rise_px = (crossing(measured, 0.9, 150, 220) - crossing(measured, 0.1, 150, 220)) / 0.8;
    const double fall_px = (crossing(measured, 0.1, 225, 300) - crossing(measured, 0.9, 225, 300)) / 0.8;
    EXPECT_NEAR(rise_px, kExposure * speed_px, 1);
    EXPECT_NEAR(fall_px, kExposure * speed_px, 1);
    for (int x = 0; x < 175; ++x) EXPECT_NEAR(measured[std::size_t(x)], 0, 0.02) << x;
}

INSTANTIATE_TEST_SUITE_P(Methods, MovingBox,
                         testing::Values("", R"("background": "neighbours")", R"("method": "jimenez_2014")"));

// ---- hostile input ----

TEST(MotionBlur, SlowsDownWhatIsFasterThanItsLimit) {
    SyntheticScene scene{.width = 200, .height = 32, .background_depth_m = 5};
    scene.box = SyntheticBox{.x = -210, .y = 0, .width = 20, .height = 32, .velocity_x = 300, .depth_m = 2};
    const Capture capture = make_capture(scene, 1);  // from 90 to 110; 150 px while the shutter is open
    for (const char* method : {"bowles_2012", "jimenez_2014", "guertin_2014", "mcguire_2012"}) {
        const Image blurred = blur(capture, fmt::format(R"("max_blur": 24, "method": "{}")", method));
        for (int x = 0; x < 200; ++x) {
            if (x < 90 - 25 || x >= 110 + 25) {
                EXPECT_EQ(blurred.at(x, 16, 0), 0) << method << " " << x;
            }
            EXPECT_TRUE(std::isfinite(blurred.at(x, 16, 0))) << method << " " << x;
        }
        EXPECT_GT(blurred.at(80, 16, 0), 0.05) << method;
    }
}

TEST(MotionBlur, TakesWhatIsNoNumberForRest) {
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                infinity = std::numeric_limits<float>::infinity();
    Capture capture = pillar_before_moving_stripes(30), cleaned = capture;
    for (int y = 0; y < 48; ++y)
        for (int x = 10; x < 40; ++x) {
            set_velocity(capture, x, y, y % 2 ? nan : infinity, y % 3 ? -infinity : nan);
            set_velocity(cleaned, x, y, 0, 0);
        }
    const Image blurred = blur(capture);
    EXPECT_EQ(largest_difference(blurred, blur(cleaned)), 0);
    each_pixel(blurred,
               [&](int x, int y) { ASSERT_TRUE(std::isfinite(blurred.at(x, y, 0))) << x << " " << y; });
}

TEST(MotionBlur, AtTheEdgesOfThePictureStaysInIt) {
    Capture capture = stripes(64, 64);
    each_pixel(capture.images["color"], [&](int x, int y) {
        set_velocity(capture, x, y, x < 32 ? -3000.0f : 1e30f, y < 32 ? 300.0f : -1e30f);
        capture.images["depth"].at(x, y, 0) = (x + y) % 3 ? 2 : std::numeric_limits<float>::infinity();
    });
    const Image blurred = blur(capture, R"("max_blur": 256)");
    each_pixel(blurred, [&](int x, int y) {
        ASSERT_GE(blurred.at(x, y, 0), 0.2499f) << x << " " << y;
        ASSERT_LE(blurred.at(x, y, 0), 0.75f) << x << " " << y;
    });
}

TEST(MotionBlur, IsTheSameOnTheOtherSoftwareBackend) {
    const Capture capture = pillar_before_moving_stripes(17);
    LookRunner other(look_of_step("motion_blur", ""), gpu::Backend::egl_software);
    EXPECT_EQ(largest_difference(blur(capture), other.color(capture)), 0);
}

}  // namespace
}  // namespace aftershade::test::motion_blur
