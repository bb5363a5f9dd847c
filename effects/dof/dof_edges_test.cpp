// What dof must do at edges of which it knows both sides: against closed forms.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "effects/dof/dof_bars.h"
#include "framework/image/role.h"
#include "tests/aperture_checks.h"

namespace aftershade::test::dof_edges {
namespace {

using dof::disk_left_of;

constexpr int kWidth = 96, kHeight = 64;

/// Opacity at the middle of column `x` of what covers the columns from `left` to `right`, through a disk.
double opacity_of(double left, double right, int x, double radius_px) {
    return disk_left_of((right - x - 0.5) / radius_px) - disk_left_of((left - x - 0.5) / radius_px);
}

struct Column {
    float light, depth_m;
};

/// A picture whose rows are all alike.
Capture picture_of_columns(const std::function<Column(int x)>& column_at) {
    Capture capture =
        make_capture({.width = kWidth, .height = kHeight, .background_depth_m = kApertureFocusM}, 0);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            for (int c = 0; c < 3; ++c) capture.images["color"].at(x, y, c) = column_at(x).light;
            capture.images["depth"].at(x, y, 0) = column_at(x).depth_m;
        }
    return capture;
}

Image blurred(const std::function<Column(int x)>& column_at, double radius_px) {
    return through_aperture("dof", picture_of_columns(column_at), radius_px, R"("blades": 0)");
}

/// The edge of a wall in focus lies within a texel of half size, beside a far wall and in the blur of a near
/// bar. The wall's light stays in the wall.
TEST(DofEdges, AFocusedEdgeBesideAFarBlurDoesNotLeakIntoIt) {
    constexpr int edge = 47, left = 60, right = 63;
    constexpr float wall = 0.8f, far_wall = 0.2f, bar = 0.05f, far_wall_m = kApertureFocusM / 0.625f;
    constexpr double radius_px = 20;  // gathered from texels of 2 px
    const Image out = blurred(
        [&](int x) {
            return x < edge                 ? Column{wall, kApertureFocusM}
                   : x < left || x >= right ? Column{far_wall, far_wall_m}
                                            : Column{bar, kApertureNearM};
        },
        radius_px);
    for (int y = 20; y < 44; ++y)
        for (int x = edge; x < left - 8; ++x) {
            const double opacity = opacity_of(left, right, x, radius_px);
            EXPECT_NEAR(out.at(x, y, 0), opacity * bar + (1 - opacity) * far_wall, 0.02) << x << " " << y;
        }
}

/// Blurs of more than 4 px are gathered at half size. What bringing them to full size adds to their width is
/// taken from the aperture.
TEST(DofEdges, ABlurGatheredAtHalfSizeIsAsWideAsItsAperture) {
    constexpr int left = 40, right = 72;
    for (const double radius_px : {4.5, 5.5, 7.0}) {
        const Image out = blurred(
            [&](int x) {
                return x >= left && x < right ? Column{0, kApertureNearM} : Column{1, kApertureFocusM};
            },
            radius_px);
        // The variance of a blur along x, px squared, from what it brings across a straight edge.
        const auto variance = [&](const auto& opacity_at) {
            double sum = 0;
            for (int x = left - 12; x < left + 12; ++x)
                sum += 2 * std::abs(x + 0.5 - left) * (x < left ? opacity_at(x) : 1 - opacity_at(x));
            return sum;
        };
        EXPECT_NEAR(variance([&](int x) { return 1 - double(out.at(x, 32, 0)); }),
                    variance([&](int x) { return opacity_of(left, right, x, radius_px); }), 0.3)
            << radius_px;
    }
}

/// With a radius of a pixel, the pixels' own size counts.
TEST(DofEdges, ANarrowBlurCoversAsMuchAsItsAperture) {
    constexpr int left = 40, right = 72;
    for (const double radius_px : {0.7, 0.8, 1.0, 1.2, 1.5}) {
        const Image out = blurred(
            [&](int x) {
                return x >= left && x < right ? Column{0, kApertureNearM} : Column{1, kApertureFocusM};
            },
            radius_px);
        EXPECT_NEAR(1 - double(out.at(left - 1, 32, 0)), opacity_of(left, right, left - 1, radius_px), 0.025)
            << radius_px;
    }
}

/// A ball in focus covers two fifths of a column of pixels, and a wall that is a little out of focus the
/// rest.
TEST(DofEdges, AnAntialiasedEdgeInFocusStaysBeforeANarrowBlur) {
    constexpr int edge = 47;
    constexpr float ball = 0.8f, wall = 0.2f, share = 0.4f, wall_m = kApertureFocusM * 1.2f;
    const float mixed = share * ball + (1 - share) * wall;
    Capture capture = picture_of_columns([&](int x) {
        return x < edge ? Column{ball, kApertureFocusM} : Column{x == edge ? mixed : wall, wall_m};
    });
    Image first = capture.images["color"], first_depth = capture.images["depth"], second(kWidth, kHeight, 4),
          second_depth(kWidth, kHeight, 1);
    std::ranges::fill(second_depth.floats(), std::numeric_limits<float>::infinity());
    for (int y = 0; y < kHeight; ++y) {
        for (int c = 0; c < 4; ++c) {
            first.at(edge, y, c) = share * (c < 3 ? ball : 1);
            second.at(edge, y, c) = c < 3 ? wall : 1;
        }
        first_depth.at(edge, y, 0) = kApertureFocusM;
        second_depth.at(edge, y, 0) = wall_m;
    }
    capture.images[RoleId::of_layer(0, "color")] = std::move(first);
    capture.images[RoleId::of_layer(0, "depth")] = std::move(first_depth);
    capture.images[RoleId::of_layer(1, "color")] = std::move(second);
    capture.images[RoleId::of_layer(1, "depth")] = std::move(second_depth);
    const Image out = through_aperture("dof", capture, 16, R"("blades": 0)");
    for (int y = 20; y < 44; ++y) EXPECT_NEAR(out.at(edge, y, 0), mixed, 0.03) << y;
}

/// One ray a pixel: a column of the wall has a colour between those of a bar and of the wall beyond it, as a
/// mixture of both would have. All other silhouettes are sharp, so it is none.
TEST(DofEdges, TextureBesideASilhouetteIsNoMixtureWhereSilhouettesAreSharp) {
    constexpr float wall = 0.1f, bar = 0.6f, stripe = 0.4f;
    constexpr double radius_px = 8;
    constexpr int stripe_x = 43;
    const auto is_bar = [](int x) { return x % 16 >= 8 && x % 16 < 11; };
    const Image out = blurred(
        [&](int x) {
            return is_bar(x) ? Column{bar, kApertureNearM}
                             : Column{x == stripe_x ? stripe : wall, kApertureFocusM};
        },
        radius_px);
    double opacity = 0;
    for (int left = 8; left < kWidth; left += 16) opacity += opacity_of(left, left + 3, stripe_x, radius_px);
    for (int y = 20; y < 44; ++y)
        EXPECT_NEAR(out.at(stripe_x, y, 0), opacity * bar + (1 - opacity) * stripe, 0.03) << y;
}

/// In tiles near the upper right bar a blur may come from afar, so what lies in front is gathered at half
/// size. Below row 48 it is gathered at full size.
TEST(DofEdges, ABlurContinuesBelowTilesThatAWiderOneReaches) {
    constexpr float wall = 0.8f, bar = 0.1f;
    constexpr int left = 40, right = 46;
    constexpr double radius_px = 20, wall_px = 7.8, bar_px = 3.6, upper_px = 5.7;
    const auto depth_m = [&](double coc_px) { return float(kApertureFocusM / (1 - coc_px / radius_px)); };
    Capture capture = picture_of_columns([&](int x) {
        return x >= left && x < right ? Column{bar, depth_m(bar_px)} : Column{wall, depth_m(wall_px)};
    });
    for (int y = 0; y < 32; ++y)
        for (int x = 60; x < 64; ++x) capture.images["depth"].at(x, y, 0) = depth_m(upper_px);
    const Image out = through_aperture("dof", capture, radius_px, R"("blades": 0)");
    for (int y = 40; y < 56; ++y)
        for (int x = left - 6; x < right + 6; ++x) {
            const double opacity = opacity_of(left, right, x, bar_px);
            EXPECT_NEAR(out.at(x, y, 0), opacity * bar + (1 - opacity) * wall, 0.04) << x << " " << y;
        }
}

}  // namespace
}  // namespace aftershade::test::dof_edges
