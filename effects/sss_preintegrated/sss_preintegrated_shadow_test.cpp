// Scattering by lookup into shadows: beside them against the profile's edge response.

#include <gtest/gtest.h>

#include "effects/sss_preintegrated/sss_preintegrated_test.h"

namespace aftershade::test::preintegrated {
namespace {

/// Largest distance from the expected light at x mm from the picture's middle, in its middle line.
std::array<double, 3> off_line(const Image& light,
                               const std::function<double(double x_mm, double d_mm)>& expected) {
    std::array<double, 3> result{};
    for (int x = 0; x < light.width(); ++x)
        for (std::size_t c = 0; c < 3; ++c) {
            const double x_mm = (x + 0.5 - light.width() / 2.0) * kMmPerPx;
            result[c] = std::max(
                result[c], std::abs(light.at(x, light.height() / 2, int(c)) - expected(x_mm, kEdgeD[c])));
        }
    return result;
}

TEST(SssPreintegrated, IsTheEdgeResponseBesideAStraightShadow) {
    const scene::Scene scene = scene::shipped_scene("plane_edge");
    Capture capture = scene::SceneRenderer(scene, 480, 8, 2).render_capture(1);
    capture.header.lights = {sun({0, 0, -1})};
    const Image light = scattered(capture, burley(kEdgeD) + R"(, "max_shadow_radius": 160)");
    const auto off = off_line(light, edge);
    for (std::size_t c = 0; c < 3; ++c) {
        RecordProperty(fmt::format("worst_{}", c), fmt::format("{:.5f}", off[c]));
        EXPECT_LT(off[c], 0.01) << kEdgeD[c];
    }
}

TEST(SssPreintegrated, FindsAnEdgeThatRunsAslant) {
    Capture capture = plane(480, 320);
    shade(capture, [](double x, double y) { return 0.8 * x + 0.6 * y > 0 ? 1.0 : 0.0; });
    const Image light = scattered(capture, burley(kEdgeD) + R"(, "max_shadow_radius": 160)");
    const auto off =
        off_line(light, [](double x, double d) { return edge(0.8 * x + 0.6 * 0.5 * kMmPerPx, d); });
    for (std::size_t c = 0; c < 3; ++c) {
        RecordProperty(fmt::format("worst_{}", c), fmt::format("{:.5f}", off[c]));
        EXPECT_LT(off[c], 0.01) << kEdgeD[c];
    }
}

/// Penumbrae that rise evenly: the mean of the edge response over their width.
TEST(SssPreintegrated, WidensPenumbraeByTheirWidth) {
    for (const double width_mm : {60.0, 240.0, 700.0}) {
        Capture capture = plane();
        shade(capture, [&](double x, double) { return std::clamp(x * kMmPerPx / width_mm + 0.5, 0.0, 1.0); });
        const Image light = scattered(capture, burley(kEdgeD) + R"(, "max_shadow_radius": 160)");
        const auto off = off_line(light, [&](double x, double d) {
            double sum = 0;
            for (int i = 0; i < 200; ++i) sum += edge(x + ((i + 0.5) / 200 - 0.5) * width_mm, d);
            return sum / 200;
        });
        for (std::size_t c = 0; c < 3; ++c) {
            RecordProperty(fmt::format("worst_{}_{}", width_mm, c), fmt::format("{:.5f}", off[c]));
            EXPECT_LT(off[c], 0.035) << width_mm << " " << kEdgeD[c];
        }
    }
}

/// One of two lights is shadowed: half of the light goes through the edge.
TEST(SssPreintegrated, KnowsShadowsOfOneOfSeveralLights) {
    Capture capture = plane();
    shade(capture, [](double x, double) { return x > 0 ? 1.0 : 0.5; });
    capture.header.lights = {sun({0, 0, -1}, kPi / 2), sun({0, 0, -1}, kPi / 2)};
    const Image light = scattered(capture, burley(kEdgeD) + R"(, "max_shadow_radius": 160)");
    const auto off = off_line(light, [](double x, double d) { return 0.5 + 0.5 * edge(x, d); });
    for (std::size_t c = 0; c < 3; ++c) EXPECT_LT(off[c], 0.01) << kEdgeD[c];
}

TEST(SssPreintegrated, LeavesShadowsAsSharpAsTheyAreWithoutPenumbra) {
    Capture capture = plane();
    shade(capture, [](double x, double) { return x > 0 ? 1.0 : 0.0; });
    const Image light = scattered(capture, burley(kEdgeD) + R"(, "penumbra": false)");
    for (int c = 0; c < 3; ++c) EXPECT_LT(worst(capture, light, capture.images.at("irradiance"), c), 1e-5);
}

}  // namespace
}  // namespace aftershade::test::preintegrated
