// The sum over all facets: against closed forms, a sum in double over curved surface, and what holds at
// silhouettes.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/scattering_checks.h"

namespace aftershade::test::sss_exact {
namespace {

constexpr const char* kEffect = "sss_exact";

/// 192 px across are 12 d and more to each side of the edge: 1 % of the light of the widest channel lies
/// beyond.
TEST(SssExact, HasTheEdgeResponseOfEachChannel) {
    const int size = 192;
    const Image image = scattered(scattering_step(kEffect, burley_of_px(8, 9, 10, size)),
                                  lit_plane(size, size, edge_light(size)));
    EXPECT_LT(edge_error(image, {8, 9, 10}, 40, 2), 0.01);
}

TEST(SssExact, HasTheModulationOfACosine) {
    expect_modulation_of_a_cosine(kEffect, {128, {3.8, 2.5, 1.5}, {12, 24, 48}, 48, 2});
}

TEST(SssExact, LeavesEvenLightEven) {
    for (const char* normalize : {"missing", "all"})
        expect_even_light_stays(kEffect, R"("normalize": ")" + std::string(normalize) + "\"", 1e-3);
}

TEST(SssExact, KeepsTheEnergyOfLightFarInsideTheSilhouette) {
    expect_energy_kept(kEffect, "", 0.005);
}
TEST(SssExact, LetsNothingCrossSilhouettes) {
    expect_nothing_crosses_silhouettes(kEffect, "");
}
TEST(SssExact, LeavesTheBitsOfWhatDoesNotScatter) {
    expect_the_rest_keeps_its_bits(kEffect, "");
}
TEST(SssExact, TakesEachObjectsProfile) {
    expect_profiles_by_object(kEffect, "");
}
TEST(SssExact, KnowsTheWorldsUnit) {
    expect_world_unit_scales(kEffect, "");
}
TEST(SssExact, LeavesLightThatIsNoNumberAlone) {
    expect_no_number_stays_alone(kEffect, "");
}

TEST(SssExact, ChangesTheHeadOfSuzanneAlone) {
    // A twentieth of the profile's width keeps the sum small.
    expect_the_head_of_suzanne_alone_changes(kEffect, R"("world_unit": 20000, "passes": 4)");
}

TEST(SssExact, IsTheSameInAnyNumberOfPasses) {
    const Capture capture = lit_plane(80, 48, edge_light(80));
    const std::string profile = burley_of_px(3, 2, 1, 80);
    const Image one = scattered(scattering_step(kEffect, profile, R"("passes": 1)"), capture);
    const Image many = scattered(scattering_step(kEffect, profile, R"("passes": 7)"), capture);
    // The order of some thousands of additions of shares of 1.
    EXPECT_LT(largest_change(one, many), 2e-5);
}

/// Six Gaussians of the shipped skin on a plane: an edge is the sum of their error functions.
TEST(SssExact, SumsTheGaussiansOfSkin) {
    const int size = 160;
    const double mm = mm_per_px(size);
    // Of a skin so large that the third Gaussian's deviation, sqrt(0.187) mm, has 3 px.
    const double unit = 1000 * 0.43 / (3 * mm);
    const Image image =
        scattered(scattering_step(kEffect, "\"skin\"", R"("world_unit": )" + std::to_string(unit)),
                  lit_plane(size, size, edge_light(size)));
    const double variance[] = {0.0064, 0.0484, 0.187, 0.567, 1.99, 7.41};
    const double weight[] = {0.233, 0.100, 0.118, 0.113, 0.358, 0.078};
    for (int off = -40; off < 40; ++off) {
        const double x_mm = (off + 0.5) * mm * unit / 1000;
        double expected = 0;
        for (int k = 0; k < 6; ++k)
            expected += weight[k] * 0.5 * std::erfc(-x_mm / std::sqrt(2 * variance[k]));
        EXPECT_NEAR(image.at(size / 2 + off, size / 2, 0), expected, 0.01) << off;
    }
}

/// A ramp in depth under lit stripes: the integral in double, each pixel's facet cut into a grid, the pixel's
/// own finely.
TEST(SssExact, IsTheIntegralByDistanceInSpaceOverASlantedPlane) {
    const int width = 64, height = 40;
    const double per_px = 36.0 / 50 / width;
    for (const double slope : {0.5, 1.5, 3.0}) {
        Capture capture = lit_plane(width, height, [](int x, int, int) { return x % 16 < 4 ? 1.0f : 0.0f; });
        const auto depth_of = [&](double x) { return 1 / (1 - slope * per_px * (x - width / 2.0)); };
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) capture.images.at("depth").at(x, y, 0) = float(depth_of(x + 0.5));
        const double d_mm = 3 * mm_per_px(width);
        const Image image = scattered(
            scattering_step(kEffect, burley_of_px(3, 3, 3, width), R"("normalize": "all")"), capture);
        const auto position = [&](double x, double y) {
            const double z = 1000 * depth_of(x);
            return std::array<double, 3>{z * per_px * (x - width / 2.0), z * per_px * (y - height / 2.0), z};
        };
        for (int x = 16; x < width - 16; x += 5) {
            const int y = height / 2;
            const auto at = position(x + 0.5, y + 0.5);
            double sum = 0, share = 0;
            for (int v = 0; v < height; ++v)
                for (int u = 0; u < width; ++u) {
                    const int grid = u == x && v == y                             ? 64
                                     : std::abs(u - x) < 4 && std::abs(v - y) < 8 ? 8
                                                                                  : 2;
                    double weight = 0;
                    for (int k = 0; k < grid * grid; ++k) {
                        const double px = u + (k % grid + 0.5) / grid, py = v + (k / grid + 0.5) / grid;
                        const auto there = position(px, py);
                        // Surface over the picture's area goes as depth cubed, with the plane's own slope a
                        // constant.
                        weight += std::pow(depth_of(px), 3) / (grid * grid) *
                                  reference::burley_profile(
                                      std::hypot(at[0] - there[0], at[1] - there[1], at[2] - there[2]), d_mm);
                    }
                    sum += weight * capture.images.at("irradiance").at(u, v, 0);
                    share += weight;
                }
            EXPECT_NEAR(image.at(x, y, 0), sum / share, 0.01) << x << " slope " << slope;
        }
    }
}

/// However steep a plane, what is seen of it never has more than the whole profile.
TEST(SssExact, FindsNoMoreThanTheWholeProfileOnASlantedPlane) {
    const int width = 64, height = 40;
    const double per_px = 36.0 / 50 / width;
    Capture capture = lit_plane(width, height, [](int, int, int) { return 1.0f; });
    for (const auto& [across, down] : {std::pair(0.0, 0.0), {1.5, 0.0}, {0.0, 4.0}, {3.0, 3.0}, {9.0, 0.0}}) {
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                capture.images.at("depth").at(x, y, 0) =
                    float(1 / (1 - per_px * 0.2 *
                                       (across * (x + 0.5 - width / 2.0) + down * (y + 0.5 - height / 2.0))));
        for (const double d : {0.5, 1.0, 3.0}) {
            const Image image = scattered(
                scattering_step(kEffect, burley_of_px(d, d, d, width), R"("normalize": "none")"), capture);
            EXPECT_LT(image.at(width / 2, height / 2, 0), 1.03) << across << " " << down << " d " << d;
            EXPECT_GT(image.at(width / 2, height / 2, 0), 0.8) << across << " " << down << " d " << d;
        }
    }
}

/// A step of depth by 40 d within one object: what lies behind is too far away in space.
TEST(SssExact, CountsDistanceInSpaceNotInThePicture) {
    const int width = 80, height = 48;
    const auto light = [](float right) {
        return [right](int x, int, int) { return x >= 40 ? right : 0.5f; };
    };
    const auto capture_of = [&](float right) {
        Capture capture = lit_plane(width, height, light(right));
        const float back_m = 1 + float(40 * 3 * mm_per_px(width) / 1000);
        for (int y = 0; y < height; ++y)
            for (int x = 40; x < width; ++x) capture.images.at("depth").at(x, y, 0) = back_m;
        return capture;
    };
    const std::string look = scattering_step(kEffect, burley_of_px(3, 3, 3, width));
    const Image dark = scattered(look, capture_of(0)), bright = scattered(look, capture_of(1));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 40; ++x) ASSERT_NEAR(dark.at(x, y, 0), bright.at(x, y, 0), 1e-4) << x << " " << y;
}

TEST(SssExact, HasTheAxesOfPathTracersOnAPlaneAsTheDistance) {
    const Capture capture = lit_plane(96, 64, edge_light(96));
    const std::string profile = burley_of_px(5, 3, 2, 96);
    const Image space = scattered(scattering_step(kEffect, profile), capture);
    const Image axes = scattered(scattering_step(kEffect, profile, R"("geometry": "axes")"), capture);
    EXPECT_LT(largest_change(space, axes), 1e-5);
}

}  // namespace
}  // namespace aftershade::test::sss_exact
