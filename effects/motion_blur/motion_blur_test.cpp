// What motion_blur must do, against closed forms and against renderers' own shutters.
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "framework/image/role.h"
#include "tests/motion_checks.h"
#include "tests/real_captures.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test::motion_blur {
namespace {

constexpr double kExposure = 0.5;  // frames, of the default shutter_angle

Image blur(const Capture& capture, const std::string& params = "") {
    LookRunner runner(look_of_step("motion_blur", params), gpu::Backend::osmesa);
    return runner.color(capture);
}

void set_velocity(Capture& capture, int x, int y, float vx, float vy) {
    for (const char* role : {"velocity", "velocity_next"}) {
        capture.images[role].at(x, y, 0) = vx;
        capture.images[role].at(x, y, 1) = vy;
    }
}

template <typename Function>
void each_pixel(const Image& image, Function function) {
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) function(x, y);
}

double largest_difference(const Image& a, const Image& b) {
    return compare_images(a, b, 3).max.value;
}

// ---- renderers' shutters ----

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

// ---- closed forms ----

/// Vertical stripes of different heights of light, over the whole picture.
Capture stripes(int width, int height, double depth_m = 5) {
    Capture capture = make_capture({.width = width, .height = height, .background_depth_m = float(depth_m)});
    Image& color = capture.images["color"];
    each_pixel(color, [&](int x, int y) {
        for (int c = 0; c < 3; ++c) color.at(x, y, c) = 0.25f + 0.5f * float((x * 7 + c * 3) % 11) / 11;
    });
    return capture;
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
    const int speed_px =
        20;  // 10 px while the shutter is open: as many samples, at the middles of pixels' tenths
    Capture capture = stripes(128, 32);
    const Image& color = capture.images["color"];
    each_pixel(color, [&](int x, int y) { set_velocity(capture, x, y, speed_px, 0); });
    const Image blurred = blur(capture);
    for (int x = 16; x < 112; ++x) {
        // The integral of the picture, read linearly, from -5 to +5 px, by its trapezoids.
        double expected = 0;
        for (int i = -5; i <= 5; ++i)
            expected += (std::abs(i) == 5 ? 0.5 : 1.0) * color.at(x + i, 16, 0) / 10;
        EXPECT_NEAR(blurred.at(x, 16, 0), expected, 0.002) << x;
    }
}

TEST(MotionBlur, LeavesAPictureAtRestAloneBitForBit) {
    for (const char* method : {"bowles_2012", "jimenez_2014", "guertin_2014", "mcguire_2012"}) {
        const Capture capture = stripes(96, 40);
        const Image blurred = blur(capture, fmt::format(R"("method": "{}")", method));
        EXPECT_EQ(largest_difference(blurred, capture.images.at("color")), 0) << method;
    }
}

/// A thing at rest, 2 m away, before a background that moves.
Capture pillar_before_moving_stripes(float speed_px) {
    Capture capture = stripes(160, 48);
    Image& color = capture.images["color"];
    each_pixel(color, [&](int x, int y) {
        const bool is_pillar = x >= 60 && x < 100;
        set_velocity(capture, x, y, is_pillar ? 0 : speed_px, 0);
        if (!is_pillar) return;
        capture.images["depth"].at(x, y, 0) = 2;
        capture.images["object_id"].uint_at(x, y, 0) = 2;
        for (int c = 0; c < 3; ++c) color.at(x, y, c) = 0.9f;
    });
    return capture;
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

/// Mean over the exposure of the part of pixel `x` that lies between two edges, which move by `way_px`.
double coverage(int x, double left, double right, double way_px) {
    constexpr int times = 256;
    double sum = 0;
    for (int i = 0; i < times; ++i) {
        const double shift = way_px * ((i + 0.5) / times - 0.5);
        sum += std::max(std::min(right + shift, x + 1.0) - std::max(left + shift, double(x)), 0.0);
    }
    return sum / times;
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

TEST(MotionBlur, OpensAtTheFramesTimeOrClosesThen) {
    // A box of 16 px that moves right by 24 px a frame: 12 px while the shutter is open.
    SyntheticScene scene{.width = 128, .height = 32, .background_depth_m = 5};
    scene.box = SyntheticBox{.x = 32, .y = 0, .width = 16, .height = 32, .velocity_x = 24, .depth_m = 2};
    const Capture capture = make_capture(scene, 1);  // from 56 to 72
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
    SyntheticScene scene{.width = 128, .height = 32, .background_depth_m = 5};
    scene.box = SyntheticBox{.x = 32, .y = 0, .width = 16, .height = 32, .velocity_x = 24, .depth_m = 2};
    const Capture capture = make_capture(scene, 1);
    const auto rows = [](double scale) {
        return fmt::format(R"("objects": {{"rows": [{{"object": 2, "scale": {}}}]}})", scale);
    };
    EXPECT_EQ(largest_difference(blur(capture, rows(0)), capture.images.at("color")), 0);
    EXPECT_EQ(largest_difference(blur(capture, rows(0.5)), blur(capture, R"("shutter_angle": 90)")), 0);
    EXPECT_GT(largest_difference(blur(capture, rows(1)), capture.images.at("color")), 0.4);
}

float disc_light(int x) {
    return x >= 96 && x < 112 ? 1.0f : 0.1f;
}

/// A box that covers half of a bright disc's place at frame 1, and none of it in the frames beside.
Capture box_over_disc(int frame) {
    SyntheticScene scene{.width = 160, .height = 48, .background_depth_m = 5};
    scene.box = SyntheticBox{
        .x = 60, .y = 0, .width = 24, .height = 48, .velocity_x = 32, .depth_m = 2, .color = {0, 0, 0}};
    Capture capture = make_capture(scene, frame);
    each_pixel(capture.images["color"], [&](int x, int y) {
        if (capture.images["object_id"].uint_at(x, y, 0) == 0)
            for (int c = 0; c < 3; ++c) capture.images["color"].at(x, y, c) = disc_light(x);
    });
    return capture;
}

/// Mean error at frame 1, against the closed form: the box's left edge moves from 84 to 100 while the shutter
/// is open, its right one from 108 to 124.
double error_of_box_over_disc(const Image& blurred) {
    double sum = 0;
    for (int x = 80; x < 130; ++x) {
        const double at = x + 0.5;
        const double covered = std::clamp((at - 84) / 16, 0.0, 1.0) - std::clamp((at - 108) / 16, 0.0, 1.0);
        sum += std::abs(blurred.at(x, 24, 0) - double(disc_light(x)) * (1 - covered));
    }
    return sum / 50;
}

TEST(MotionBlur, ShowsWhatNeighboursShowOfTheUncovered) {
    const Capture before = box_over_disc(0), now = box_over_disc(1), after = box_over_disc(2);
    FrameInputs frame;
    frame.capture = &now;
    frame.previous = &before;
    frame.next = &after;
    const auto error = [&](const char* background) {
        LookRunner runner(look_of_step("motion_blur", fmt::format(R"("background": "{}")", background)),
                          gpu::Backend::osmesa);
        return error_of_box_over_disc(runner.run(frame).images.at("color"));
    };
    EXPECT_LT(error("neighbours"), 0.02);
    EXPECT_GT(error("estimate"), 2 * error("neighbours"));
}

TEST(MotionBlur, ShowsWhatTheSecondLayerHasOfTheUncovered) {
    Capture capture = box_over_disc(1);
    const double guessed = error_of_box_over_disc(blur(capture));
    Image color(160, 48, 4), velocity(160, 48, 2);
    each_pixel(color, [&](int x, int y) {
        if (capture.images["object_id"].uint_at(x, y, 0) == 0) return;
        for (int c = 0; c < 3; ++c) color.at(x, y, c) = disc_light(x);
        color.at(x, y, 3) = 1;
    });
    capture.images[layer_role(1, "color")] = std::move(color);
    capture.images[layer_role(1, "velocity")] = std::move(velocity);
    const double known = error_of_box_over_disc(blur(capture));
    EXPECT_LT(known, 0.02);
    EXPECT_GT(guessed, 2 * known);
}

/// Columns of a capture with layers, the nearest surface first. The flat roles are those of the largest
/// share.
struct LayerColumn {
    float light, share, depth_m, velocity_px;  ///< share of what the layers in front leave
};

template <typename ColumnAt>
Capture layered(int width, int layers, ColumnAt column_at) {
    constexpr int height = 48;
    Capture capture = make_capture({.width = width, .height = height, .background_depth_m = 5});
    for (int k = 0; k < layers; ++k) {
        capture.images[layer_role(k, "color")] = Image(width, height, 4);
        capture.images[layer_role(k, "depth")] = Image(width, height, 1);
        for (const char* role : {"velocity", "velocity_next"})
            capture.images[layer_role(k, role)] = Image(width, height, 2);
    }
    each_pixel(capture.images["color"], [&](int x, int y) {
        float left = 1, largest = 0, light = 0;
        for (int k = 0; k < layers; ++k) {
            const LayerColumn column = column_at(k, x);
            for (int c = 0; c < 3; ++c)
                capture.images[layer_role(k, "color")].at(x, y, c) = column.light * column.share;
            capture.images[layer_role(k, "color")].at(x, y, 3) = column.share;
            capture.images[layer_role(k, "depth")].at(x, y, 0) = column.depth_m;
            for (const char* role : {"velocity", "velocity_next"})
                capture.images[layer_role(k, role)].at(x, y, 0) = column.velocity_px;
            light += left * column.share * column.light;
            if (left * column.share > largest) {
                largest = left * column.share;
                capture.images["depth"].at(x, y, 0) = column.depth_m;
                set_velocity(capture, x, y, column.velocity_px, 0);
            }
            left *= 1 - column.share;
        }
        for (int c = 0; c < 3; ++c) capture.images["color"].at(x, y, c) = light;
    });
    return capture;
}

constexpr LayerColumn kNothing{0, 0, std::numeric_limits<float>::infinity(), 0};

TEST(MotionBlur, MovesWhatHasTwoFifthsOfAPixelByTwoFifths) {
    constexpr float share = 0.4f;
    const Capture capture = layered(160, 2, [](int layer, int x) {
        const LayerColumn wall{0.2f, 1, 5, 0};
        const bool is_edge = x == 70 || x == 90, is_box = x >= 70 && x <= 90;
        if (layer == 0) return is_box ? LayerColumn{0.9f, is_edge ? share : 1.0f, 2, 24} : wall;
        return is_box ? wall : kNothing;
    });
    const Image blurred = blur(capture);
    for (int x = 55; x < 105; ++x) {
        const double covered = coverage(x, 71 - double(share), 90 + double(share), 24 * kExposure);
        EXPECT_NEAR(blurred.at(x, 24, 0), 0.2 + 0.7 * covered, 0.03) << x;
    }
}

TEST(MotionBlur, LeavesAPixelOfTwoSurfacesAtRestAlone) {
    Capture capture = layered(160, 2, [](int layer, int x) {
        const LayerColumn wall{0.2f, 1, 5, 0};
        if (layer == 0 && x < 80) return LayerColumn{0.5f, 1, 3, 20};
        if (layer == 0) return x == 90 ? LayerColumn{0.9f, 0.4f, 2, 0} : wall;
        return x == 90 ? wall : kNothing;
    });
    const Image blurred = blur(capture);
    EXPECT_NEAR(blurred.at(90, 24, 0), 0.4 * 0.9 + 0.6 * 0.2, 1e-5);
    EXPECT_NEAR(blurred.at(91, 24, 0), 0.2, 1e-5);
    EXPECT_LT(blurred.at(78, 24, 0), 0.49);
}

/// Two things, one behind the other, leave the same place, the nearer one faster.
TEST(MotionBlur, ShowsWhatTheThirdLayerHasBehindTwoThingsThatMove) {
    const auto wall_light = [](int x) { return x >= 60 && x < 70 ? 1.0f : 0.1f; };
    const auto column = [&](int layer, int x) {
        const LayerColumn wall{wall_light(x), 1, 5, 0};
        const bool is_covered = x >= 60 && x < 84;
        if (!is_covered) return layer == 0 ? wall : kNothing;
        return layer == 0 ? LayerColumn{0, 1, 2, 32} : layer == 1 ? LayerColumn{0.5f, 1, 3, 16} : wall;
    };
    const Image blurred = blur(layered(160, 3, column));
    double error = 0;
    for (int x = 50; x < 84; ++x) {
        double expected = 0;
        for (int i = 0; i < 256; ++i) {
            const double t = (i + 0.5) / 256 - 0.5, at = x + 0.5;
            const auto covers = [&](double way_px) { return at >= 60 + way_px * t && at < 84 + way_px * t; };
            expected += (covers(16) ? 0 : covers(8) ? 0.5 : double(wall_light(x))) / 256;
        }
        error += std::abs(blurred.at(x, 24, 0) - expected) / 34;
    }
    EXPECT_LT(error, 0.02);
}

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
