// What dof must do at silhouettes, where one layer does not know what lies behind: against closed forms.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "effects/dof/dof_bars.h"
#include "framework/image/role.h"
#include "tests/render/effect_fixture.h"

namespace aftershade::test::dof {
namespace {

Image through_neighbours(const FrameInputs& frame, const std::string& background) {
    const std::string more = R"("blades": 0, "background": ")" + background + "\"";
    return Bench(EffectFolder(), Lens{kRadiusPx, kWidth}.look("dof", more)).run(frame).images.at("color");
}

void expect_bar(const Image& out, double left, double right, double light, double tolerance) {
    for (int y = 20; y < 44; ++y) {
        if (y % 8 < 2 || y % 8 > 5) continue;  // patches are smoothed, across the edges of stripes too
        for (int x = 24; x < 72; ++x) {
            const double opacity = bar_opacity(x, left, right);
            EXPECT_NEAR(out.at(x, y, 0), opacity * light + (1 - opacity) * double(stripe(y)), tolerance)
                << x << " " << y;
        }
    }
}

TEST(DofHidden, AThinWireDissolvesOverWhatItHid) {
    const Column wire{0.05f, true};
    expect_bar(blurred(columns_over_stripes(47, {wire, wire})), 47, 49, 0.05, 0.01);
}

TEST(DofHidden, ABarHasNoStepAlongItsBlurredSide) {
    const Column bar{0.05f, true};
    const Image out = blurred(columns_over_stripes(43, std::vector<Column>(10, bar)));
    expect_bar(out, 43, 53, 0.05, 0.07);  // chords aslant reach the next stripe
    // The closed form's steepest step from column to column, and half as much again.
    double steepest = 0;
    for (int x = 24; x < 72; ++x)
        steepest = std::max(steepest, std::abs(bar_opacity(x + 1, 43, 53) - bar_opacity(x, 43, 53)));
    for (int x = 24; x < 72; ++x)
        EXPECT_LE(std::abs(out.at(x + 1, 20, 0) - out.at(x, 20, 0)), 1.5 * steepest * (0.8 - 0.05)) << x;
}

/// One edge's mixed column has the bar's depth, the other's that of the stripes, as one sample of depth a
/// pixel leaves it.
TEST(DofHidden, AntialiasedEdgesLeaveNoOutline) {
    const Column bar{0.05f, true}, near_edge{0.05f, true, 0.4f}, far_edge{0.05f, false, 0.6f};
    const Image out = blurred(columns_over_stripes(45, {far_edge, bar, bar, bar, bar, near_edge}));
    expect_bar(out, 45.5, 50.6, 0.05, 0.03);
}

/// The lit side of a wire outshines its dark side, and is darker than what lies behind it.
TEST(DofHidden, AWireThatIsLitOnOneSideIsNoHighlight) {
    const Image out = blurred(columns_over_stripes(47, {{0.15f, true}, {0.01f, true}}));
    expect_bar(out, 47, 49, 0.08, 0.02);
}

/// A layer of the capture: premultiplied light, its alpha, its depth; alpha 0 where there is none.
struct LayerPixel {
    float light, alpha, depth_m;
};

template <typename PixelAt>
void add_layer(Capture& capture, int layer, PixelAt pixel_at) {
    Image color(kWidth, kHeight, 4), depth(kWidth, kHeight, 1);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const LayerPixel pixel = pixel_at(x, y);
            for (int c = 0; c < 3; ++c) color.at(x, y, c) = pixel.light;
            color.at(x, y, 3) = pixel.alpha;
            depth.at(x, y, 0) = pixel.depth_m;
        }
    capture.images[RoleId::of_layer(layer, "color")] = std::move(color);
    capture.images[RoleId::of_layer(layer, "depth")] = std::move(depth);
}

constexpr float kNowhere = std::numeric_limits<float>::infinity();

/// What no chord could guess: behind the bar the stripes stand the other way round.
TEST(DofHidden, TheSecondLayerOfTheCaptureShowsThrough) {
    Capture capture = columns_over_stripes(43, std::vector<Column>(10, Column{0.05f, true}));
    add_layer(capture, 1, [](int x, int y) {
        return x >= 43 && x < 53 ? LayerPixel{1 - stripe(y), 1, kApertureFocusM} : LayerPixel{0, 0, kNowhere};
    });
    const Image out = blurred(capture);
    for (int y = 20; y < 44; ++y)
        for (int x = 44; x < 52; ++x) {
            const double opacity = bar_opacity(x, 43, 53);
            EXPECT_NEAR(out.at(x, y, 0), opacity * 0.05 + (1 - opacity) * double(1 - stripe(y)), 0.02)
                << x << " " << y;
        }
}

/// Its pixels have the depth of the stripes, which cover more of them: by one sample of depth it is no wire.
TEST(DofHidden, AWireThatHasTwoFifthsOfItsPixelsSpreadsTwoFifths) {
    constexpr float share = 0.4f, light = 0.05f;
    Capture capture = columns_over_stripes(47, {{light, false, 1 - share}});
    add_layer(capture, 0, [&](int x, int y) {
        return x == 47 ? LayerPixel{share * light, share, kApertureFocusM / 2}
                       : LayerPixel{stripe(y), 1, kApertureFocusM};
    });
    add_layer(capture, 1, [&](int x, int y) {
        return x == 47 ? LayerPixel{stripe(y), 1, kApertureFocusM} : LayerPixel{0, 0, kNowhere};
    });
    const Image out = blurred(capture);
    double spread = 0, expected = 0;
    for (int y = 20; y < 44; ++y)
        for (int x = 24; x < 72; ++x) {
            const double opacity = share * bar_opacity(x, 47, 48);
            EXPECT_NEAR(out.at(x, y, 0), opacity * light + (1 - opacity) * double(stripe(y)), 0.015)
                << x << " " << y;
            expected += opacity * double(stripe(y) - light);
            spread += double(stripe(y) - out.at(x, y, 0));
        }
    EXPECT_NEAR(spread / expected, 1, 0.1);
}

/// Half of a lamp stands behind a wire: as sharp a disk as the other half, dimmed by the wire's blur.
TEST(DofHidden, ALampThatALayerHasBehindAWireIsASharpDisk) {
    constexpr float lamp = 200, wall = 0.1f, lamp_m = 2 * kApertureFocusM, wall_m = 4 * kApertureFocusM;
    constexpr double lamp_radius_px = kRadiusPx / 2;
    Capture capture = columns_over_stripes(47, {{0.05f, true}});
    const auto behind = [&](int x, int y) {
        return (x == 47 || x == 48) && y == 32 ? LayerPixel{lamp, 1, lamp_m} : LayerPixel{wall, 1, wall_m};
    };
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            if (x == 47) continue;
            for (int c = 0; c < 3; ++c) capture.images["color"].at(x, y, c) = behind(x, y).light;
            capture.images["depth"].at(x, y, 0) = behind(x, y).depth_m;
        }
    add_layer(capture, 1, [&](int x, int y) { return x == 47 ? behind(x, y) : LayerPixel{0, 0, kNowhere}; });
    const Image out = blurred(capture);
    const double disk = lamp / (kPi * lamp_radius_px * lamp_radius_px);
    for (int y = 22; y < 43; ++y)
        for (int x = 36; x < 60; ++x) {
            double lit = wall;
            bool is_rim = false;
            for (const double center : {47.5, 48.5}) {
                const double distance_px = std::hypot(x + 0.5 - center, y + 0.5 - 32.5);
                is_rim = is_rim || std::abs(distance_px - lamp_radius_px) < 1;
                if (distance_px < lamp_radius_px) lit += disk;
            }
            if (is_rim) continue;
            const double opacity = bar_opacity(x, 47, 48);
            EXPECT_NEAR(out.at(x, y, 0), opacity * 0.05 + (1 - opacity) * lit, 0.04 * lit + 0.01)
                << x << " " << y;
        }
}

/// Behind a wire lies a wider one, so that all chords across end on that, and behind both are the stripes.
/// Compared with rays through every part of the lens.
TEST(DofHidden, AWireInFrontOfAnotherShowsWhatLiesBehindBoth) {
    constexpr double front_left = 47, front_right = 49, back_left = 46, back_right = 50;
    constexpr float front_light = 0.05f, back_light = 0.3f;
    Capture capture = columns_over_stripes(46, std::vector<Column>(4, Column{front_light, true}));
    for (int y = 0; y < kHeight; ++y)
        for (const int x : {46, 49}) {
            for (int c = 0; c < 3; ++c) capture.images["color"].at(x, y, c) = back_light;
            capture.images["depth"].at(x, y, 0) = kApertureFocusM / 1.5f;  // half the CoC of the front one
        }
    const Image out = blurred(capture);
    for (int y = 20; y < 44; ++y) {
        if (y % 8 < 2 || y % 8 > 5) continue;
        for (int x = 30; x < 66; ++x) {
            double light = 0, area = 0;
            for (double v = -0.99; v < 1; v += 0.02)
                for (double u = -0.995; u < 1; u += 0.01) {
                    if (u * u + v * v > 1) continue;
                    const double front_x = x + 0.5 + u * kRadiusPx, back_x = x + 0.5 + u * kRadiusPx / 2;
                    const bool in_front = front_x > front_left && front_x < front_right;
                    const bool in_back = back_x > back_left && back_x < back_right;
                    light += double(in_front ? front_light : in_back ? back_light : stripe(y));
                    area += 1;
                }
            EXPECT_NEAR(out.at(x, y, 0), light / area, 0.08) << x << " " << y;
        }
    }
}

/// Behind the bar the stripes stand the other way round, which no chord could guess and one other frame
/// shows.
TEST(DofHidden, WhatAFrameUpToThreeAwayShowsShowsThrough) {
    const std::vector<Column> bar(10, Column{0.05f, true});
    Capture now = columns_over_stripes(43, bar), open = columns_over_stripes(13, bar);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 43; x < 53; ++x) {
            now.images["velocity"].at(x, y, 0) = 30;
            for (int c = 0; c < 3; ++c) open.images["color"].at(x, y, c) = 1 - stripe(y);
        }
    const auto error = [&](int offset, const std::string& background) {
        FrameInputs frame;
        frame.capture = &now;
        for (const int other : {-3, -2, -1, 1, 2, 3})
            frame.neighbours[other] = other == offset ? &open : &now;
        const Image out = through_neighbours(frame, background);
        double largest = 0;
        for (int y = 20; y < 44; ++y)
            for (int x = 44; x < 52; ++x) {
                const double opacity = bar_opacity(x, 43, 53);
                const double expected = opacity * 0.05 + (1 - opacity) * double(1 - stripe(y));
                largest = std::max(largest, std::abs(double(out.at(x, y, 0)) - expected));
            }
        return largest;
    };
    for (const int offset : {-3, -2, -1, 1, 2, 3}) EXPECT_LT(error(offset, "neighbours"), 0.02) << offset;
    EXPECT_GT(error(-1, "estimate"), 0.2);
}

/// A wire of one row crosses an edge of the wall, which moves by 2.19 px a frame. The nearest view of the
/// pixel beside the edge is of the wall's other side. Its own side is in the rows above and below, and in a
/// view that lies further off.
TEST(DofHidden, AmongTheViewsOfNeighboursOneLikeTheSurroundingsIsTaken) {
    constexpr int row = 32, column = 48;
    constexpr float light = 0.8f, dark = 0.2f, wire = 0.05f;
    constexpr double motion_px = -2.19, edge = column + 0.5 - 0.1;
    const auto frame_at = [&](int offset) {
        Capture capture =
            make_capture({.width = kWidth, .height = kHeight, .background_depth_m = kApertureFocusM}, 0);
        const bool has_wire = offset == 0 || offset == 1 || offset == 2;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const bool is_wire = has_wire && y == row;
                const float wall = x + 0.5 - motion_px * offset < edge ? light : dark;
                for (int c = 0; c < 3; ++c) capture.images["color"].at(x, y, c) = is_wire ? wire : wall;
                if (is_wire) capture.images["depth"].at(x, y, 0) = kApertureFocusM / 2;
                capture.images["velocity"].at(x, y, 0) = is_wire ? -8.0f : float(motion_px);
            }
        return capture;
    };
    std::map<int, Capture> captures;
    FrameInputs frame;
    for (const int offset : {-3, -2, -1, 0, 1, 2, 3}) captures[offset] = frame_at(offset);
    frame.capture = &captures.at(0);
    for (const auto& [offset, capture] : captures) frame.neighbours[offset] = &capture;
    const Image out = through_neighbours(frame, "neighbours");
    const double opacity = bar_opacity(row, row, row + 1);
    for (int x = column - 8; x <= column + 8; ++x)
        EXPECT_NEAR(out.at(x, row, 0), opacity * wire + (1 - opacity) * (x + 0.5 < edge ? light : dark), 0.05)
            << x;
}

}  // namespace
}  // namespace aftershade::test::dof
