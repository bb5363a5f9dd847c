// What motion_blur must do, against closed forms.
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "effects/motion_blur/motion_blur_test.h"

namespace aftershade::test::motion_blur {
namespace {

/// A box of 16 px, 56 to 72, that moves right by 24 px a frame: 12 px while the shutter is open.
Capture box_that_moves_12_px() {
    SyntheticScene scene{.width = 128, .height = 32, .background_depth_m = 5};
    scene.box = SyntheticBox{.x = 32, .y = 0, .width = 16, .height = 32, .velocity_x = 24, .depth_m = 2};
    return make_capture(scene, 1);
}

/// A small light at rest in front of a plane that moves: its own pixels show it, and a px around, which is
/// how near a path must lead.
TEST(MotionBlur, DoesNotDragALightAtRestAlongWhatMovesBehindIt) {
    Capture capture = stripes(96, 48);
    each_pixel(capture.images["color"], [&](int x, int y) { set_velocity(capture, x, y, 16, 0); });
    for (int y = 23; y < 25; ++y)
        for (int x = 47; x < 49; ++x) {
            for (int c = 0; c < 3; ++c) capture.images["color"].at(x, y, c) = 50;
            capture.images["depth"].at(x, y, 0) = 2;
            set_velocity(capture, x, y, 0, 0);
        }
    const Image out = blur(capture);
    each_pixel(out, [&](int x, int y) {
        const bool is_light = x >= 47 && x < 49 && y >= 23 && y < 25;
        const bool is_beside = x >= 46 && x < 50 && y >= 22 && y < 26;
        if (is_light) {
            EXPECT_NEAR(out.at(x, y, 0), 50, 0.5) << x << " " << y;
        } else if (!is_beside) {
            EXPECT_LE(out.at(x, y, 0), 1) << x << " " << y;
        }
    });
}

/// The same before a plane that turns, where the place that a path leads back to may be the light's.
TEST(MotionBlur, DoesNotScatterALightAtRestOverWhatTurnsBehindIt) {
    Capture capture = stripes(96, 96);
    each_pixel(capture.images["color"], [&](int x, int y) {
        const double turn_rad = 0.8, from_x = x + 0.5 - 48, from_y = y + 0.5 - 60;  // a frame; of the middle
        const auto way = [&](double angle, double u, double v) {
            return float(u * std::cos(angle) - v * std::sin(angle) - u);
        };
        capture.images["velocity"].at(x, y, 0) = -way(-turn_rad, from_x, from_y);
        capture.images["velocity"].at(x, y, 1) = -way(-turn_rad, from_y, -from_x);
        capture.images["velocity_next"].at(x, y, 0) = way(turn_rad, from_x, from_y);
        capture.images["velocity_next"].at(x, y, 1) = way(turn_rad, from_y, -from_x);
    });
    const auto is_light = [](int x, int y) { return x >= 47 && x < 50 && y >= 39 && y < 41; };
    each_pixel(capture.images["color"], [&](int x, int y) {
        if (!is_light(x, y)) return;
        for (int c = 0; c < 3; ++c) capture.images["color"].at(x, y, c) = 50;
        capture.images["depth"].at(x, y, 0) = 4;
        set_velocity(capture, x, y, 0, 0);
    });
    const Image out = blur(capture);
    each_pixel(out, [&](int x, int y) {
        const bool is_beside = x >= 46 && x < 51 && y >= 38 && y < 42;
        if (is_light(x, y)) {
            EXPECT_NEAR(out.at(x, y, 0), 50, 0.5) << x << " " << y;
        } else if (!is_beside) {
            EXPECT_LE(out.at(x, y, 0), 1) << x << " " << y;
        }
    });
}

TEST(MotionBlur, OfAPictureThatMovesAsOneIsABoxAlongItsWay) {
    // 10 px while the shutter is open, and 50: more than the 32 samples, each of which is the mean of two
    // pixels.
    for (int way_px : {10, 50}) {
        Capture capture = stripes(192, 32);
        const Image& color = capture.images["color"];
        each_pixel(color, [&](int x, int y) { set_velocity(capture, x, y, float(2 * way_px), 0); });
        const Image blurred = blur(capture);
        const int half_px = way_px / 2;
        for (int x = 40; x < 152; ++x) {
            // The integral of the picture, read linearly, by its trapezoids.
            double expected = 0;
            for (int i = -half_px; i <= half_px; ++i)
                expected += (std::abs(i) == half_px ? 0.5 : 1.0) * color.at(x + i, 16, 0) / way_px;
            EXPECT_NEAR(blurred.at(x, 16, 0), expected, 0.002) << way_px << " px, " << x;
        }
    }
}

TEST(MotionBlur, LeavesAPictureAtRestAloneBitForBit) {
    for (const char* method : {"bowles_2012", "jimenez_2014", "guertin_2014", "mcguire_2012"}) {
        const Capture capture = stripes(96, 40);
        const Image blurred = blur(capture, fmt::format(R"("method": "{}")", method));
        EXPECT_EQ(largest_difference(blurred, capture.images.at("color")), 0) << method;
    }
}

TEST(MotionBlur, KeepsAForegroundAtRestBeforeAMovingBackgroundSharp) {
    const Capture capture = pillar_before_moving_stripes(30);
    const Image blurred = blur(capture);
    double worst = 0, moved = 0;
    for (int x = 0; x < 160; ++x) {
        const double change = std::abs(blurred.at(x, 24, 1) / capture.images.at("color").at(x, 24, 1) - 1);
        if (x >= 60 && x < 100) worst = std::max(worst, change);
        else moved = std::max(moved, change);
    }
    EXPECT_LT(worst, 0.01);
    EXPECT_GT(moved, 0.1);
}

TEST(MotionBlur, SpreadsASlowThingOverTheFasterBackgroundBesideIt) {
    Capture capture = pillar_before_moving_stripes(-48);
    each_pixel(capture.images["color"], [&](int x, int y) {
        if (x >= 60 && x < 100) return set_velocity(capture, x, y, 24, 0);
        for (int c = 0; c < 3; ++c) capture.images["color"].at(x, y, c) = 0.1f;
    });
    const Image blurred = blur(capture);
    for (int x = 40; x < 120; ++x) {
        const double covered = coverage(x, 60, 100, 24 * kExposure);
        EXPECT_NEAR(blurred.at(x, 24, 0), 0.1 + 0.8 * covered, 0.05) << x;
    }
}

/// Wherever its edge lies in a tile of 16 px: tiles that nothing comes over are left as they are. One sample
/// a px of a way of 2 px is 0.067 off.
TEST(MotionBlur, SpreadsWhatMovesByAFewPxOverTheTilesBesideIt) {
    for (int left = 60; left < 76; left += 3)
        for (const float way_px : {2.f, 6.f, 12.f}) {
            Capture capture = stripes(160, 32);
            Image& color = capture.images["color"];
            each_pixel(color, [&](int x, int y) {
                const bool is_thing = x >= left && x < left + 40;
                for (int c = 0; c < 3; ++c) color.at(x, y, c) = is_thing ? 0.9f : 0.1f;
                if (!is_thing) return;
                capture.images["depth"].at(x, y, 0) = 2;
                set_velocity(capture, x, y, way_px / float(kExposure), 0);
            });
            const Image blurred = blur(capture);
            for (int x = left - 16; x < left + 56; ++x)
                EXPECT_NEAR(blurred.at(x, 16, 0), 0.1 + 0.8 * coverage(x, left, left + 40, way_px),
                            way_px > 2 ? 0.06 : 0.07)
                    << x << " from " << left << ", " << way_px << " px";
        }
}

TEST(MotionBlur, OpensAtTheFramesTimeOrClosesThen) {
    const Capture capture = box_that_moves_12_px();
    const auto middle_px = [&](const char* phase) {
        const Image blurred = blur(capture, fmt::format(R"("shutter_phase": "{}")", phase));
        double sum = 0, moment = 0;
        for (int x = 0; x < 128; ++x) sum += blurred.at(x, 16, 0), moment += (x + 0.5) * blurred.at(x, 16, 0);
        EXPECT_NEAR(sum / 0.9, 16, 0.16) << phase;
        return moment / sum;
    };
    EXPECT_NEAR(middle_px("center"), 64, 0.2);
    EXPECT_NEAR(middle_px("start"), 70, 0.2);
    EXPECT_NEAR(middle_px("end"), 58, 0.2);
}

TEST(MotionBlur, IsScaledByObject) {
    const Capture capture = box_that_moves_12_px();
    const auto rows = [](double scale) {
        return fmt::format(R"("objects": {{"rows": [{{"object": 2, "scale": {}}}]}})", scale);
    };
    EXPECT_EQ(largest_difference(blur(capture, rows(0)), capture.images.at("color")), 0);
    EXPECT_EQ(largest_difference(blur(capture, rows(0.5)), blur(capture, R"("shutter_angle": 90)")), 0);
    EXPECT_GT(largest_difference(blur(capture, rows(1)), capture.images.at("color")), 0.4);
}

}  // namespace
}  // namespace aftershade::test::motion_blur
