// False colours against framework/image/false_color.h, which makes them in C++ for pictures of taps; arrows
// by where their mass lies.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "effects/visualize/visualize_test.h"
#include "framework/compare/metrics.h"
#include "tests/backends.h"
#include "tests/crop.h"

namespace aftershade::test::visualize {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

TEST(Visualize, AVelocityToTheRightHasTheWheelsHueAtAngleZero) {
    const Image image = shown(moving(8, 8, 8, 0), R"("max": 8, "legend": false)");
    expect_color(image, 3, 3, {1, 0, 0}, "to the right");
    EXPECT_EQ(image.at(3, 3, 3), 1.0f);
}

TEST(Visualize, VelocitiesHaveTheColorsOfTheTapsWheel) {
    Capture capture = moving(32, 8, 0, 0);
    const auto velocity = [](int x, int y) {
        const double angle = 2 * std::numbers::pi * x / 32 + 0.01, length = 2.5 * y;  // up to 17.5 px, max 10
        return std::array<float, 2>{float(length * std::cos(angle)), float(length * std::sin(angle))};
    };
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 32; ++x) set_velocity(capture, x, y, velocity(x, y)[0], velocity(x, y)[1]);
    const Image image = shown(capture, R"("max": 10, "legend": false)");
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 32; ++x) {
            const auto v = velocity(x, y);
            expect_color(image, x, y, wheel_color(v[0] / 10, v[1] / 10), "wheel");
        }
}

TEST(Visualize, DepthFallsFromBrightToDarkByFactorsOrByMetres) {
    Capture capture = moving(16, 4, 0, 0);
    for (int x = 0; x < 16; ++x)
        for (int y = 0; y < 4; ++y) capture.images.at("depth").at(x, y, 0) = float(std::exp2(0.5 * x));
    capture.images.at("depth").at(0, 0, 0) = 0;
    capture.images.at("depth").at(1, 0, 0) = kInf;
    capture.images.at("depth").at(2, 0, 0) = -1;
    const std::string ends = R"("show": "depth", "legend": false, "near": 1, "far": 128)";
    const Image log = shown(capture, ends), linear = shown(capture, ends + R"(, "depth_scale": "linear")");
    for (int x = 0; x < 16; ++x) {
        expect_color(log, x, 2, ramp_color(1 - 0.5f * float(x) / 7), "log");
        expect_color(linear, x, 2, ramp_color(1 - (float(std::exp2(0.5 * x)) - 1) / 127), "linear");
    }
    expect_color(log, 0, 0, {0, 0, 0}, "depth 0");
    expect_color(log, 1, 0, kNothingHitColor, "nothing hit");
    expect_color(log, 2, 0, pixel_fault_color(PixelFault::negative), "negative");
    // Without ends of its own the scale has the picture's: its nearest and farthest pixel.
    const Image fitted = shown(capture, R"("show": "depth", "legend": false)");
    expect_color(fitted, 0, 2, ramp_color(1), "nearest");
    expect_color(fitted, 15, 2, ramp_color(0), "farthest");
}

TEST(Visualize, GivesEveryIdAColorOfItsOwnAndNoneBlack) {
    constexpr int kWidth = 40, kHeight = 25;
    Capture capture = moving(kWidth, kHeight, 0, 0);
    for (int i = 0; i < kWidth * kHeight; ++i)
        capture.images.at("object_id").uint_at(i % kWidth, i / kWidth, 0) = std::uint32_t(i);
    const Image image = shown(capture, R"("show": "object_id", "legend": false)");
    std::set<DisplayColor> colors;
    for (int i = 0; i < kWidth * kHeight; ++i) {
        expect_color(image, i % kWidth, i / kWidth, id_color(std::uint32_t(i)), "id " + std::to_string(i));
        colors.insert(at(image, i % kWidth, i / kWidth));
    }
    EXPECT_EQ(colors.size(), std::size_t(kWidth * kHeight));
    expect_color(image, 0, 0, {0, 0, 0}, "id 0");
}

TEST(Visualize, ShowsNormalsAsTheTapDoes) {
    Capture capture = moving(8, 8, 0, 0);
    for (int c = 0; c < 3; ++c) capture.images.at("normal").at(2, 3, c) = std::array{0.6f, -0.8f, 0.0f}[c];
    for (int c = 0; c < 3; ++c) capture.images.at("normal").at(3, 3, c) = 0;
    const Image image = shown(capture, R"("show": "normal", "legend": false)");
    expect_color(image, 2, 3, {0.8f, 0.1f, 0.5f}, "normal");
    expect_color(image, 3, 3, {0, 0, 0}, "no normal");
}

TEST(Visualize, FaultsAreLoud) {
    Capture capture = moving(16, 16, 1, 0);
    set_velocity(capture, 3, 4, 1, kNaN);
    set_velocity(capture, 4, 4, -kInf, 2);
    set_velocity(capture, 5, 4, kInf, kNaN);
    const Image image = shown(capture, R"("legend": false, "max": 1)");
    expect_color(image, 3, 4, pixel_fault_color(PixelFault::nan), "NaN");
    expect_color(image, 4, 4, pixel_fault_color(PixelFault::infinite), "-Inf");
    expect_color(image, 5, 4, pixel_fault_color(PixelFault::nan), "NaN and Inf");
    expect_color(image, 6, 4, {1, 0, 0}, "sound");
    // Nor do they spoil the scale.
    expect_color(shown(capture, R"("legend": false)"), 6, 4, {1, 0, 0}, "sound");
}

TEST(Visualize, ANegativeValueIsLoudInAScaleFromZeroAndALightBelowBlackToo) {
    Capture capture = moving(16, 16, 0, 0);
    capture.images.at("mask").at(2, 2, 0) = -0.25f;
    capture.images.at("mask").at(3, 2, 0) = 0.75f;
    capture.images.at("color").at(5, 5, 1) = -1;
    const std::string in = R"(, "in": {"image": "capture.mask"})";
    const Image from_zero = shown(capture, R"("show": "scalar", "high": 1, "legend": false)", in);
    expect_color(from_zero, 2, 2, pixel_fault_color(PixelFault::negative), "from 0");
    expect_color(from_zero, 3, 2, ramp_color(0.75f), "from 0");
    const Image from_below = shown(capture, R"("show": "scalar", "low": -1, "high": 1, "legend": false)", in);
    expect_color(from_below, 2, 2, ramp_color(0.375f), "from -1");
    const Image light = shown(capture, R"("show": "light", "exposure": -1, "legend": false)");
    expect_color(light, 5, 5, pixel_fault_color(PixelFault::negative), "light");
    EXPECT_NEAR(light.at(6, 5, 0), srgb_of_clamped(0.25), 1e-5);
}

TEST(Visualize, SaysWhatIsMissing) {
    Capture capture = moving(192, 108, 3, 0);
    capture.images.erase("velocity");
    const Image image = shown(capture, R"("legend": false, "picture": 0.5)");
    const double grey = 0.5 * srgb_of_clamped(0.5);
    int loud = 0, dim = 0;
    for (int y = 0; y < 108; ++y)
        for (int x = 0; x < 192; ++x) {
            loud += at(image, x, y) == pixel_fault_color(PixelFault::infinite);
            dim += std::abs(image.at(x, y, 0) - grey) < 1e-4;
        }
    EXPECT_GT(loud, 80);
    EXPECT_EQ(loud + dim, 192 * 108);
}

// ---- taps ----

const char* const kLens =
    R"({"effect": "dof", "params": {"focus_distance": 3, "f_number": 0.05, "highlights": "gather"}}, )";

Capture lens_capture(int width, int height) {
    Capture capture = moving(width, height, 0, 0);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            capture.images.at("depth").at(x, y, 0) = 1 + 0.07f * float(x) + 0.02f * float(y);
    return capture;
}

TEST(Visualize, ATextureOfAnEarlierStepArrivesExactly) {
    LookRunner runner(
        look(R"("show": "signed", "max": 6, "legend": false)", R"(, "in": {"image": "dof.coc"})", kLens),
        gpu::test_backend(), {"dof.coc"});
    const FrameResult result = runner.run(lens_capture(64, 36));
    const Image& coc = result.taps.at("dof.coc");
    bool front = false, behind = false;
    for (int y = 0; y < 36; ++y)
        for (int x = 0; x < 64; ++x) {
            const float value = coc.at(x, y, 0);
            front |= value < -1;
            behind |= value > 1;
            expect_color(result.images.at("display"), x, y, diverging_color(value / 6), "coc");
        }
    EXPECT_TRUE(front && behind);
}

/// Every pixel has the colour of the texel of a grid of 16 px tiles that covers it.
void expect_tiles(int width, int height, const std::string& texel) {
    LookRunner runner(look(R"("show": "signed", "channel": "g", "max": 6, "legend": false)" + texel,
                           R"(, "in": {"image": "dof.tile_coc"})", kLens),
                      gpu::test_backend(), {"dof.tile_coc"});
    const FrameResult result = runner.run(lens_capture(width, height));
    const Image& tiles = result.taps.at("dof.tile_coc");
    ASSERT_EQ(tiles.width(), (width + 15) / 16);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            expect_color(result.images.at("display"), x, y, diverging_color(tiles.at(x / 16, y / 16, 1) / 6),
                         "tile");
}

TEST(Visualize, ATexelOfASmallerTextureIsASquare) {
    expect_tiles(96, 40, "");
}

TEST(Visualize, TheLookSaysHowLargeATexelIsWhereSizesDoNot) {
    expect_tiles(100, 60, R"(, "texel": 16)");  // 7 x 4 tiles could be of 15 px, too
}

// ---- arrows and tiles ----

struct Mass {
    double sum = 0, x = 0, y = 0;
    double farthest = 0;  ///< from (32.5, 32.5), px
};

/// Of all that is not black, about the pixel where the only arrow of 64 x 64 px begins.
Mass mass_of(const Image& image) {
    Mass mass;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const double w = std::max({image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)});
            mass.sum += w;
            mass.x += w * (x - 32);
            mass.y += w * (y - 32);
            if (w > 0.5) mass.farthest = std::max(mass.farthest, std::hypot(x - 32.0, y - 32.0));
        }
    mass.x /= mass.sum;
    mass.y /= mass.sum;
    return mass;
}

TEST(Visualize, ArrowsPointWhereVelocityPoints) {
    for (int k = 0; k < 12; ++k) {
        const double angle = 2 * std::numbers::pi * k / 12 + 0.1;
        const auto vx = float(10 * std::cos(angle)), vy = float(10 * std::sin(angle));
        const Image image =
            shown(moving(64, 64, vx, vy),
                  R"("show": "arrows", "spacing": 64, "scale": 2.5, "picture": 0, "legend": false)");
        const Mass mass = mass_of(image);
        const double turn = std::remainder(std::atan2(mass.y, mass.x) - angle, 2 * std::numbers::pi);
        EXPECT_NEAR(turn, 0, 0.02) << k;
        // The whole arrow lies before its pixel; its tip is thinner than a pixel.
        EXPECT_NEAR(std::hypot(mass.x, mass.y), 12, 2) << k;
        EXPECT_NEAR(mass.farthest, 24, 1.5) << k;
    }
}

TEST(Visualize, ArrowsStandOnALatticeAndShowFaultsAndRest) {
    Capture capture = moving(64, 64, 0, 0);
    set_velocity(capture, 48, 16, kNaN, 0);
    const Image image = shown(capture, R"("show": "arrows", "spacing": 32, "picture": 0, "legend": false)");
    for (const int y : {16, 48})
        for (const int x : {16, 48})
            if (x == 48 && y == 16) expect_color(image, x, y, pixel_fault_color(PixelFault::nan), "NaN");
            else EXPECT_NEAR(image.at(x, y, 0), 0.6f, 1e-3) << x << " " << y;
    EXPECT_EQ(image.at(32, 32, 0), 0.0f);
}

TEST(Visualize, ALongVelocityMakesAnArrowNoLongerThanThePicturesDiagonal) {
    for (const float length : {300.0f, 1e9f, 3e38f}) {
        const Image image = shown(moving(64, 64, 0, -length),
                                  R"("show": "arrows", "spacing": 64, "picture": 0, "legend": false)");
        EXPECT_GT(image.at(32, 4, 0) + image.at(32, 4, 1), 0.9f) << length;
        for (const float value : image.floats()) ASSERT_TRUE(std::isfinite(value)) << length;
        EXPECT_EQ(image.at(32, 40, 1), 0.0f) << length;
    }
}

TEST(Visualize, TilesShowTheirLongestVelocity) {
    Capture capture = moving(64, 48, 0, 0);
    set_velocity(capture, 21, 20, 0, 3);
    set_velocity(capture, 30, 29, -8, 0);  // the same tile of 16 px; longer
    set_velocity(capture, 50, 2, kInf, 0);
    const Image image =
        shown(capture, R"("show": "tiles", "tile_size": 16, "max": 10, "picture": 0, "legend": false)");
    const DisplayColor full = wheel_color(-0.8f, 0);
    expect_color(image, 20, 16, full, "outline");
    expect_color(image, 16, 25, full, "outline");
    expect_color(image, 17, 17, {full[0] / 2, full[1] / 2, full[2] / 2}, "inside");
    expect_color(image, 5, 5, {0, 0, 0}, "at rest");
    expect_color(image, 0, 5, {0.25f, 0.25f, 0.25f}, "outline at rest");
    expect_color(image, 55, 0, pixel_fault_color(PixelFault::infinite), "outline of a fault");
    int ink = 0;  // the number 8
    for (int y = 17; y < 32; ++y)
        for (int x = 17; x < 32; ++x) ink += at(image, x, y) == DisplayColor{1, 1, 1};
    EXPECT_EQ(ink, 17);
}

// ---- windows ----

TEST(Visualize, ACropHasTheSameColorsLegendAndArrows) {
    Capture capture = make_capture({.width = 160, .height = 100, .background = {0.2f, 0.3f, 0.4f}});
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 160; ++x)
            set_velocity(capture, x, y, float(3 * std::sin(0.05 * x)), float(3 * std::cos(0.07 * y)));
    const Window window{37, 21, 148, 96};
    for (const char* params : {R"("max": 4)", R"("show": "arrows", "spacing": 12)"}) {
        const Image whole = shown(capture, params), part = shown(cropped(capture, window), params);
        constexpr int kReach = 8;  // of arrows that begin outside
        for (int y = kReach; y < part.height() - kReach; ++y)
            for (int x = kReach; x < part.width() - kReach; ++x)
                ASSERT_EQ(at(part, x, y), at(whole, x + window.min_x, y + window.min_y))
                    << params << " at (" << x << ", " << y << ")";
    }
}

TEST(Visualize, LaysItselfOverTheDisplayThatAnEarlierStepMade) {
    const Capture capture = moving(64, 64, 0, 0);
    const Image image = shown(capture, R"("show": "arrows", "picture": 1, "legend": false)", "",
                              R"({"effect": "view_transform", "params": {"exposure": 1}}, )");
    EXPECT_NEAR(image.at(2, 2, 0), 1.0f, 1e-5);
}

}  // namespace
}  // namespace aftershade::test::visualize
