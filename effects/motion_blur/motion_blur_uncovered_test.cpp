// What motion_blur shows where a thing has moved away, and where things share a pixel: of the frames
// beside, and of layers.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "effects/motion_blur/motion_blur_test.h"

namespace aftershade::test::motion_blur {
namespace {

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
    frame.neighbours[-1] = &before;
    frame.neighbours[1] = &after;
    const auto error = [&](const char* background) {
        LookRunner runner(look_of_step("motion_blur", fmt::format(R"("background": "{}")", background)),
                          gpu::test_backend());
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
    capture.images[RoleId::of_layer(1, "color")] = std::move(color);
    capture.images[RoleId::of_layer(1, "velocity")] = std::move(velocity);
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
        capture.images[RoleId::of_layer(k, "color")] = Image(width, height, 4);
        capture.images[RoleId::of_layer(k, "depth")] = Image(width, height, 1);
        for (const char* role : {"velocity", "velocity_next"})
            capture.images[RoleId::of_layer(k, role)] = Image(width, height, 2);
    }
    each_pixel(capture.images["color"], [&](int x, int y) {
        float left = 1, largest = 0, light = 0;
        for (int k = 0; k < layers; ++k) {
            const LayerColumn column = column_at(k, x);
            for (int c = 0; c < 3; ++c)
                capture.images[RoleId::of_layer(k, "color")].at(x, y, c) = column.light * column.share;
            capture.images[RoleId::of_layer(k, "color")].at(x, y, 3) = column.share;
            capture.images[RoleId::of_layer(k, "depth")].at(x, y, 0) = column.depth_m;
            for (const char* role : {"velocity", "velocity_next"})
                capture.images[RoleId::of_layer(k, role)].at(x, y, 0) = column.velocity_px;
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

}  // namespace
}  // namespace aftershade::test::motion_blur
