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

Image blurred(const std::function<Column(int x)>& column_at, double radius_px, const std::string& more = "") {
    return through_aperture("dof", picture_of_columns(column_at), radius_px, R"("blades": 0)" + more);
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

/// The signed CoC of a near cylinder is -(end + slope sqrt(s)), s px inside its edge. From u radii off the
/// lens's middle its edge lies at the least s - u (end + slope sqrt(s)), which is -(u end + u^2 slope^2 / 4).
TEST(DofEdges, ARoundSurfaceIsAsWideAsItsEndAndNotAsItsLastPixel) {
    constexpr int left = 40, right = 72;
    constexpr double radius_px = 2.5, slope = 0.6, middle = 0.5 * (left + right);
    for (const auto& [end, more] : {std::pair(0.6, ""), std::pair(0.8, ""), std::pair(1.0, ""),
                                    std::pair(0.8, R"(, "highlight_repair": false)")}) {
        const auto depth_at = [&](int x) {
            const double inside_px = 0.5 * (right - left) - std::abs(x + 0.5 - middle);
            const double coc_px = end + slope * std::sqrt(std::max(inside_px, 0.0));
            return kApertureFocusM / (1 + (kApertureFocusM / kApertureNearM - 1) * coc_px / radius_px);
        };
        const Image out = blurred(
            [&](int x) {
                return x >= left && x < right ? Column{0, float(depth_at(x))} : Column{1, kApertureFocusM};
            },
            radius_px, more);
        const double edge_radii = (std::sqrt(end * end + slope * slope / 2) - end) / (slope * slope / 2);
        EXPECT_NEAR(1 - double(out.at(left - 1, 32, 0)), 1 - disk_left_of(edge_radii), 0.04) << end << more;
        EXPECT_NEAR(1 - double(out.at(left - 2, 32, 0)), 0, 0.01) << end;
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

/// The same with one layer, beside a wide blur, and with balls that are a little out of focus.
TEST(DofEdges, AnAntialiasedEdgeInFocusOrNearlySoStaysBeforeAWideBlur) {
    constexpr int edge = 47, steps = 64;
    constexpr float ball = 0.8f, wall = 0.2f;
    constexpr double radius_px = 16;
    for (const double ball_px : {0.0, 0.4, 0.8})
        for (const double share : {0.25, 0.4, 0.5}) {
            const double ball_m =
                kApertureFocusM / (1 + (kApertureFocusM / kApertureNearM - 1) * ball_px / radius_px);
            const double mixed = share * double(ball) + (1 - share) * double(wall);
            const Image out = blurred(
                [&](int x) {
                    return x < edge ? Column{ball, float(ball_m)}
                                    : Column{x == edge ? float(mixed) : wall, kApertureFarM};
                },
                radius_px);
            double opacity = 0;  // mean over the pixel
            for (int i = 0; i < steps; ++i) {
                const double to_edge_px = share - (i + 0.5) / steps;
                opacity += (ball_px > 0      ? disk_left_of(to_edge_px / ball_px)
                            : to_edge_px > 0 ? 1
                                             : 0) /
                           steps;
            }
            EXPECT_NEAR(out.at(edge, 32, 0), double(wall) + opacity * double(ball - wall), 0.07)
                << ball_px << " " << share;
        }
}

/// A ball in focus, premultiplied, before nothing: its share of a pixel stays its alpha.
TEST(DofEdges, AnAntialiasedEdgeInFocusKeepsItsAlphaBeforeNothing) {
    constexpr int edge = 47;
    constexpr float ball = 0.8f, share = 0.4f;
    Capture capture = picture_of_columns([&](int x) {
        return x < edge ? Column{ball, kApertureFocusM} : Column{x == edge ? share * ball : 0, kApertureFarM};
    });
    for (int y = 0; y < kHeight; ++y)
        for (int x = edge; x < kWidth; ++x) capture.images["color"].at(x, y, 3) = x == edge ? share : 0;
    const Image out = through_aperture("dof", capture, 16, R"("blades": 0)");
    EXPECT_NEAR(out.at(edge, 32, 0), share * ball, 0.03);
    EXPECT_NEAR(out.at(edge, 32, 3), share, 0.03);
    // A strip of a wall behind, which the blur thins.
    for (int y = 0; y < kHeight; ++y)
        for (int x = edge; x < edge + 4; ++x) capture.images["color"].at(x, y, 3) = 1;
    const double alpha = through_aperture("dof", capture, 16, R"("blades": 0)").at(edge, 32, 3);
    EXPECT_GT(alpha, share);
    EXPECT_LT(alpha, 0.75);
}

/// The distance along a slanted plane is even but for rounding, which must not make it round.
TEST(DofEdges, ASlantedPlaneIsNotRound) {
    constexpr int left = 40, right = 56;
    constexpr double radius_px = 8, step_px = 0.3;
    double least = 1, most = 0;
    for (int i = 0; i < 16; ++i) {
        const auto depth_at = [&](int x) {
            const double coc_px = 1 + 1e-4 * i + step_px * (x - left);
            return kApertureFocusM / (1 + (kApertureFocusM / kApertureNearM - 1) * coc_px / radius_px);
        };
        const Image out = blurred(
            [&](int x) {
                return x >= left && x < right ? Column{0, float(depth_at(x))} : Column{1, kApertureFarM};
            },
            radius_px);
        least = std::min(least, double(out.at(left - 1, 32, 0)));
        most = std::max(most, double(out.at(left - 1, 32, 0)));
    }
    EXPECT_LT(most - least, 0.005);
}

/// One ray a pixel: a near ball is darker towards its edge, where its last pixel has a colour between the
/// ball's and the wall's. Each pixel keeps its light.
TEST(DofEdges, TheShadingOfARoundSurfaceIsNoMixtureWhereSilhouettesAreSharp) {
    constexpr int left = 40, right = 72;
    constexpr float wall = 0.1f;
    constexpr double radius_px = 3;
    const auto light_at = [](int x) {
        const int inside = std::min(x - left, right - 1 - x);
        return inside < 0 ? wall : inside == 0 ? 0.5f : inside == 1 ? 0.75f : 0.8f;
    };
    const Image out = blurred(
        [&](int x) {
            return Column{light_at(x), x >= left && x < right ? kApertureNearM : kApertureFocusM};
        },
        radius_px);
    for (int x = left - 4; x < left + 4; ++x) {
        double light = (1 - opacity_of(left, right, x, radius_px)) * double(wall);
        for (int i = left; i < right; ++i) light += opacity_of(i, i + 1, x, radius_px) * double(light_at(i));
        EXPECT_NEAR(out.at(x, 32, 0), light, 0.02) << x;
    }
}

/// One ray a pixel: a column of the wall has a colour between those of a bar and of the wall beyond it, as a
/// mixture of both would have. All other silhouettes are sharp, so it is none.
TEST(DofEdges, TextureBesideASilhouetteIsNoMixtureWhereSilhouettesAreSharp) {
    constexpr float wall = 0.1f, bar = 0.6f, stripe = 0.4f;
    constexpr double radius_px = 8;
    constexpr int stripe_x = 43;
    const auto is_bar = [](int x) { return x % 16 >= 8 && x % 16 < 11; };
    double opacity = 0;
    for (int left = 8; left < kWidth; left += 16) opacity += opacity_of(left, left + 3, stripe_x, radius_px);
    // Black bars before a black wall, further on, have no light to mix either.
    for (const int lit_columns : {kWidth, 62}) {
        const Image out = blurred(
            [&](int x) {
                const float lit = x < lit_columns ? 1 : 0;
                return is_bar(x) ? Column{lit * bar, kApertureNearM}
                                 : Column{lit * (x == stripe_x ? stripe : wall), kApertureFocusM};
            },
            radius_px);
        for (int y = 20; y < 44; ++y)
            EXPECT_NEAR(out.at(stripe_x, y, 0), opacity * bar + (1 - opacity) * stripe, 0.03)
                << lit_columns << " " << y;
    }
}

/// Bars whose sides lie within pixels, before a wall in focus. Antialiasing mixed two fifths of a bar into
/// the first column of the gap between them, and the gap is too narrow to have the wall's colour 2 px inside.
TEST(DofEdges, AGapOfOneOrTwoPixelsBetweenBarsShowsTheWallWithoutTheirLight) {
    constexpr float wall = 0.8f, bar = 0.1f;
    constexpr double share = 0.4, radius_px = 8;
    constexpr int gap = 42;
    for (const int second : {gap + 1, gap + 2}) {
        const auto cover = [&](double left, double right) {
            return [=](int x) {
                return std::clamp(std::min(x + 1.0, right) - std::max<double>(x, left), 0.0, 1.0);
            };
        };
        const double left = 40 - share, right = second + 2;
        const auto of_first = cover(left, gap + share), of_second = cover(second, right);
        const Image out = blurred(
            [&](int x) {
                const double bars = of_first(x) + of_second(x);
                return Column{float(bars * bar + (1 - bars) * wall),
                              bars > 0.5 ? kApertureNearM : kApertureFocusM};
            },
            radius_px);
        const double opacity =
            opacity_of(left, gap + share, gap, radius_px) + opacity_of(second, right, gap, radius_px);
        for (int y = 20; y < 44; ++y)
            EXPECT_NEAR(out.at(gap, y, 0), opacity * bar + (1 - opacity) * wall, 0.04) << second << " " << y;
    }
}

/// The right side of a bar lies in shade, as dark as two thirds of the wall's light would make it. The
/// bar's depth there says that less than half of the pixel is wall.
TEST(DofEdges, TheShadedSideOfANearBarIsNoMixture) {
    constexpr float wall = 0.15f, bar = 0.6f, shade = 0.3f;
    constexpr double radius_px = 8;
    constexpr int left = 60, right = 64;
    const Image out = blurred(
        [&](int x) {
            if (x >= left && x < right) return Column{x == right - 1 ? shade : bar, kApertureNearM};
            // A bar between two columns that antialiasing mixed: without mixtures nearby, nothing is taken
            // for one.
            const float cover = x == 19 ? 0.4f : x == 23 ? 0.6f : x > 19 && x < 23 ? 1.0f : 0.0f;
            return Column{cover * bar + (1 - cover) * wall, cover > 0.5f ? kApertureNearM : kApertureFocusM};
        },
        radius_px);
    for (int x = left - 2; x < right + 2; ++x) {
        const double lit = opacity_of(left, right - 1, x, radius_px);
        const double shaded = opacity_of(right - 1, right, x, radius_px);
        EXPECT_NEAR(out.at(x, 32, 0), lit * bar + shaded * shade + (1 - lit - shaded) * wall, 0.01) << x;
    }
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
