// Scattering by lookup: on balls against the integrals in double and the renderer's scattering, beside
// shadows against the profile's edge response, and what must not change.
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "framework/scene/renderer.h"
#include "tests/look_runner.h"
#include "tests/reference/burley.h"
#include "tests/scene/scene_text.h"

namespace aftershade::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Irradiance after the effect with these parameters, as JSON.
Image scattered(const Capture& capture, const std::string& params) {
    LookRunner runner(
        R"({"aftershade": 1, "steps": [{"effect": "sss_preintegrated", "params": {)" + params + "}}]}",
        gpu::Backend::osmesa, {"sss_preintegrated.irradiance"});
    return runner.run(capture).taps.at("sss_preintegrated.irradiance");
}

std::string burley(const std::array<double, 3>& d_mm) {
    return fmt::format(R"("scattering_profile": {{"type": "burley", "d_mm": [{}, {}, {}]}})", d_mm[0],
                       d_mm[1], d_mm[2]);
}

CaptureLight sun(const std::array<double, 3>& direction, double intensity = kPi) {
    const double length = std::hypot(direction[0], direction[1], direction[2]);
    CaptureLight light;
    light.kind = CaptureLight::Kind::directional;
    for (std::size_t c = 0; c < 3; ++c) light.direction[c] = direction[c] / length;
    light.intensity = {intensity, intensity, intensity};
    return light;
}

/// Largest difference of two pictures over the pixels of object 1.
double worst(const Capture& capture, const Image& a, const Image& b, int channel) {
    double result = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x)
            if (capture.images.at("object_id").uint_at(x, y, 0) == 1)
                result = std::max(result, std::abs(double(a.at(x, y, channel)) - b.at(x, y, channel)));
    return result;
}

/// A plane 5 m away of which 480 px show 3.6 m, under a light that shines straight at it: its irradiance
/// is 1.
Capture plane(int width = 480, int height = 8) {
    const scene::Scene scene = scene::scene_of(R"({ "aftershade": 1,
        "camera": { "position": [0, 0, 5], "focal_length": 50 }, "materials": { "wax": {} },
        "objects": [ { "id": 1, "shape": "plane", "size": [30, 30], "material": "wax" } ],
        "lights": [ { "type": "directional", "position": [0, 0, 1], "intensity": 3.14159265358979 } ] })");
    Capture capture = scene::SceneRenderer(scene, width, height, 2).render_capture(1);
    capture.header.lights = {sun({0, 0, -1})};
    return capture;
}
constexpr double kMmPerPx = 5000.0 * 36 / 50 / 480;

void shade(Capture& capture, const std::function<double(double x, double y)>& share) {
    Image& light = capture.images.at("irradiance");
    for (int y = 0; y < light.height(); ++y)
        for (int x = 0; x < light.width(); ++x)
            for (int c = 0; c < 3; ++c)
                light.at(x, y, c) *=
                    float(share(x + 0.5 - light.width() / 2.0, y + 0.5 - light.height() / 2.0));
}

const std::array<double, 3> kEdgeD{120, 90, 60};  // mm: 16, 12 and 8 px

/// Burley's edge response, also on the dark side.
double edge(double x, double d) {
    if (x == 0) return 0.5;
    return x > 0 ? reference::burley_edge_response(x, d) : 1 - reference::burley_edge_response(-x, d);
}

// ---- What must not change

TEST(SssPreintegrated, LeavesAPlaneInEvenLightAsItIs) {
    Capture capture = plane(64, 36);
    CaptureLight lamp;
    lamp.position_m = {0.3, -0.2, 0.8};
    lamp.intensity = {2, 1, 0.5};
    for (const bool is_near : {false, true}) {
        if (is_near) {
            capture.header.lights = {lamp};
            for (int y = 0; y < 36; ++y)
                for (int x = 0; x < 64; ++x) {
                    const Image& at = capture.images.at("position");
                    const double dx = 0.3 - at.at(x, y, 0), dy = -0.2 - at.at(x, y, 1);
                    const double square = dx * dx + dy * dy + 0.64;
                    for (int c = 0; c < 3; ++c)
                        capture.images.at("irradiance").at(x, y, c) =
                            float(lamp.intensity[std::size_t(c)] * 0.8 / (kPi * square * std::sqrt(square)));
                }
        }
        for (const char* profile : {R"("scattering_profile": "skin", "world_unit": 10)",
                                    R"("scattering_profile": {"type": "burley", "d_mm": [90, 30, 3]})"}) {
            const Image light = scattered(capture, profile);
            for (int y = 0; y < 36; ++y)
                for (int x = 0; x < 64; ++x)
                    for (int c = 0; c < 3; ++c) {
                        const double before = capture.images.at("irradiance").at(x, y, c);
                        ASSERT_NEAR(light.at(x, y, c), before, 5e-4 * before) << is_near << profile;
                    }
        }
    }
}

/// A ball of 1 m under a light from its left.
Capture ball(int size = 64, const std::string& more = "") {
    const scene::Scene scene = scene::scene_of(R"({ "aftershade": 1,
        "camera": { "position": [0, 0, 6], "focal_length": 90 }, "materials": { "wax": {} },
        "objects": [ { "id": 1, "shape": "sphere", "radius": 1, "material": "wax" } ],
        "lights": [ { "type": "directional", "position": [1, 0, 0], "intensity": 3.14159265358979 } ] )" +
                                               more + "}");
    Capture capture = scene::SceneRenderer(scene, size, size, 2).render_capture(1);
    capture.header.lights = {sun({-1, 0, 0})};
    return capture;
}

TEST(SssPreintegrated, ApproachesTheLightThatCameInAsTheProfileNarrows) {
    const Capture capture = ball();
    double last = 1;
    for (const double d_mm : {100.0, 30.0, 10.0, 3.0, 0.1}) {
        const double change = worst(capture, scattered(capture, burley({d_mm, d_mm, d_mm})),
                                    capture.images.at("irradiance"), 0);
        EXPECT_LT(change, last) << d_mm;
        EXPECT_LT(change, 1.2 * d_mm / 1000) << d_mm;
        last = change;
    }
    EXPECT_LT(last, 1e-3);
}

TEST(SssPreintegrated, DoesNotTouchABitOfWhatDoesNotScatter) {
    Capture capture = ball();
    capture.images["mask"] = Image(64, 64, 1);
    capture.header.roles.push_back("mask");
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            if (y < 32) capture.images.at("object_id").uint_at(x, y, 0) *= 2;
            capture.images.at("mask").at(x, y, 0) = x % 2 ? 1.0f : 0.0f;
        }
    const Image& before = capture.images.at("irradiance");
    const Image light = scattered(capture, burley({200, 100, 50}) + R"(, "object_ids": [1])");
    int changed = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 3; ++c) {
                const float a = light.at(x, y, c), b = before.at(x, y, c);
                const bool same = std::memcmp(&a, &b, sizeof a) == 0;
                if (y < 32 || x % 2 == 0) ASSERT_TRUE(same) << x << " " << y;
                else changed += !same;
            }
    EXPECT_GT(changed, 500);
}

TEST(SssPreintegrated, KeepsLightWithinItsObject) {
    Capture capture = plane();
    shade(capture, [](double x, double) { return x > 0 ? 1.0 : 0.0; });
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 240; ++x) capture.images.at("object_id").uint_at(x, y, 0) = 2;
    const Image light = scattered(capture, burley(kEdgeD) + R"(, "max_shadow_radius": 160)");
    for (int x = 0; x < 480; ++x)
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(light.at(x, 4, c), x < 240 ? 0 : 1, 1e-3) << x;
}

TEST(SssPreintegrated, PassesLightThatTheLightsDoNotExplain) {
    Capture capture = plane(64, 8);
    for (float& value : capture.images.at("irradiance").floats()) value += 0.25f;
    const Image all = scattered(capture, burley(kEdgeD) + R"(, "ambient": [0.25, 0.25, 0.25])");
    capture.header.lights.clear();
    const Image dark = scattered(capture, burley(kEdgeD));
    for (int x = 0; x < 64; ++x) {
        EXPECT_NEAR(all.at(x, 4, 0), 1.25, 1e-3);
        EXPECT_EQ(dark.at(x, 4, 0), 1.25f) << "there is no light";
    }
}

// ---- Over the terminator

using Density = std::function<double(double r_mm, int channel)>;

/// Penner and Borshukov's integral around the ring.
double on_ring(const Density& density, int c, double cosine, double radius_mm) {
    constexpr int kSteps = 20000;
    const double angle = std::acos(cosine);
    double sum = 0, all = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double x = ((i + 0.5) / kSteps * 2 - 1) * kPi;
        const double share = density(std::abs(2 * radius_mm * std::sin(x / 2)), c);
        sum += share * std::max(std::cos(angle + x), 0.0);
        all += share;
    }
    return sum / all;
}

/// Over the ball's surface, by circles around the place.
double on_ball(const Density& density, int c, double cosine, double radius_mm) {
    constexpr int kSteps = 1500, kRound = 720;
    const double sine = std::sqrt(1 - cosine * cosine);
    double sum = 0, all = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double at = (i + 0.5) / kSteps, x = at * at * kPi;
        const double share = density(2 * radius_mm * std::sin(x / 2), c) * std::sin(x) * at;
        double light = 0;
        for (int k = 0; k < kRound; ++k)
            light +=
                std::max(cosine * std::cos(x) + sine * std::sin(x) * std::cos((k + 0.5) / kRound * kPi), 0.0);
        sum += share * light / kRound;
        all += share;
    }
    return sum / all;
}

/// d'Eon and Luebke's skin.
double skin(double r_mm, int c) {
    const double gaussians[6][4] = {{0.0064, 0.233, 0.455, 0.649}, {0.0484, 0.100, 0.336, 0.344},
                                    {0.187, 0.118, 0.198, 0},      {0.567, 0.113, 0.007, 0.007},
                                    {1.99, 0.358, 0.004, 0},       {7.41, 0.078, 0, 0}};
    double sum = 0;
    for (const auto& g : gaussians) sum += g[c + 1] / (2 * kPi * g[0]) * std::exp(-r_mm * r_mm / (2 * g[0]));
    return sum;
}

TEST(SssPreintegrated, IsThePublishedRingIntegralOnABall) {
    // Numbers of another implementation (numpy), skin, radius 1 and 5 mm.
    EXPECT_NEAR(on_ring(skin, 0, -0.2, 1), 0.0389, 1e-4);
    EXPECT_NEAR(on_ring(skin, 2, 0, 1), 0.0411, 1e-4);
    EXPECT_NEAR(on_ring(skin, 1, 0.5, 1), 0.4951, 1e-4);
    EXPECT_NEAR(on_ring(skin, 0, 0, 5), 0.0196, 1e-4);
    const Capture capture = ball(96);
    for (const double radius_mm : {1.0, 5.0, 25.0}) {
        const Image light = scattered(
            capture,
            fmt::format(R"("integral": "ring", "scattering_profile": "skin", "world_unit": {})", radius_mm));
        double off = 0;
        for (int x = 8; x < 88; ++x)
            for (int c = 0; c < 3; ++c) {
                if (capture.images.at("object_id").uint_at(x, 48, 0) == 0) continue;
                const double cosine = capture.images.at("normal").at(x, 48, 0);
                off = std::max(off, std::abs(light.at(x, 48, c) - on_ring(skin, c, cosine, radius_mm)));
            }
        RecordProperty(fmt::format("ring_{}mm", radius_mm), fmt::format("{:.5f}", off));
        EXPECT_LT(off, 0.001) << radius_mm;
    }
}

TEST(SssPreintegrated, IsTheSurfaceIntegralOnABall) {
    const Capture capture = ball(96);
    for (const double d_mm : {20.0, 100.0, 400.0}) {
        const Image light = scattered(capture, burley({d_mm, d_mm, d_mm}));
        const auto density = [&](double r_mm, int) { return reference::burley_profile(r_mm, d_mm); };
        double off = 0;
        for (int x = 4; x < 92; x += 4) {
            if (capture.images.at("object_id").uint_at(x, 48, 0) == 0) continue;
            const double cosine = capture.images.at("normal").at(x, 48, 0);
            off = std::max(off, std::abs(light.at(x, 48, 0) - on_ball(density, 0, cosine, 1000)));
        }
        RecordProperty(fmt::format("sphere_{}mm", d_mm), fmt::format("{:.5f}", off));
        EXPECT_LT(off, 0.001) << d_mm;
    }
}

TEST(SssPreintegrated, IsNearTheRenderersScatteringOnABall) {
    const std::string material = R"("materials": { "wax": { "albedo": 0.8, "specular": 0,
        "scattering_profile": { "type": "burley", "d_mm": [200, 100, 50] } } })";
    const scene::Scene scene = scene::scene_of(R"({ "aftershade": 1,
        "camera": { "position": [0, 0, 6], "focal_length": 90 }, )" +
                                               material + R"(,
        "objects": [ { "id": 1, "shape": "sphere", "radius": 1, "material": "wax" } ],
        "lights": [ { "type": "directional", "position": [1, 0, 0], "intensity": 3.14159265358979 } ] })");
    const scene::SceneRenderer renderer(scene, 64, 64, 2);
    Capture capture = renderer.render_capture(1);
    capture.header.lights = {sun({-1, 0, 0})};
    const scene::ScatteringTruth truth = renderer.render_scattering(1, {2048, false});
    for (const char* integral : {"sphere", "ring"}) {
        const Image light =
            scattered(capture, burley({200, 100, 50}) + fmt::format(R"(, "integral": "{}")", integral));
        for (int c = 0; c < 3; ++c) {
            const double off = worst(capture, light, truth.irradiance, c);
            RecordProperty(fmt::format("{}_{}", integral, c), fmt::format("{:.4f}", off));
            // The ring is no part of a ball's surface, and Burley's profile is none for a line.
            if (std::strcmp(integral, "sphere") == 0) {
                EXPECT_LT(off, 0.002) << c;
                EXPECT_GT(worst(capture, capture.images.at("irradiance"), truth.irradiance, c), 0.02);
            }
        }
    }
}

/// Waves of 6 px in the normals, against d of 16, 12 and 8 px: their light and dark sides are one.
TEST(SssPreintegrated, LevelsBumpsThatAreSmallAgainstTheProfile) {
    Capture capture = plane(480, 64);
    capture.header.lights = {sun({-1, 0, -1})};
    Image& normal = capture.images.at("normal");
    Image& irradiance = capture.images.at("irradiance");
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 480; ++x) {
            const double turn = 0.3 * std::sin(2 * kPi * (x + 0.5) / 6);
            normal.at(x, y, 0) = float(std::sin(turn));
            normal.at(x, y, 2) = float(std::cos(turn));
            for (int c = 0; c < 3; ++c)
                irradiance.at(x, y, c) = float((std::sin(turn) + std::cos(turn)) / std::sqrt(2.0));
        }
    const Image light = scattered(capture, burley(kEdgeD) + R"(, "max_shadow_radius": 160)");
    for (int c = 0; c < 3; ++c) {
        double least = 9, most = 0, least_before = 9, most_before = 0;
        for (int x = 160; x < 320; ++x) {
            least = std::min<double>(least, light.at(x, 32, c));
            most = std::max<double>(most, light.at(x, 32, c));
            least_before = std::min<double>(least_before, irradiance.at(x, 32, c));
            most_before = std::max<double>(most_before, irradiance.at(x, 32, c));
        }
        RecordProperty(fmt::format("left_{}", c),
                       fmt::format("{:.3f}", (most - least) / (most_before - least_before)));
        EXPECT_LT(most - least, 0.5 * (most_before - least_before)) << kEdgeD[std::size_t(c)];
        EXPECT_NEAR((least + most) / 2, (least_before + most_before) / 2, 0.1);
    }
}

TEST(SssPreintegrated, TakesTheLooksLightWhereTheCaptureHasNone) {
    Capture capture = ball();
    const Image expected = scattered(capture, burley({200, 100, 50}));
    capture.header.lights.clear();
    const Image light = scattered(
        capture,
        burley({200, 100, 50}) +
            R"(, "light_direction": [-3, 0, 0], "light_intensity": [3.14159265, 3.14159265, 3.14159265])");
    for (int c = 0; c < 3; ++c) EXPECT_LT(worst(capture, light, expected, c), 1e-5);
    EXPECT_GT(worst(capture, expected, capture.images.at("irradiance"), 0), 0.05);
}

/// Where the surface is comes from the camera's matrices or from the image of positions; without both nobody
/// can tell what arrives of a near light, and its light stays as it is.
TEST(SssPreintegrated, KnowsWhereNearLightsAreByMatricesOrPositions) {
    const scene::Scene scene = scene::scene_of(R"({ "aftershade": 1,
        "camera": { "position": [0, 0, 6], "focal_length": 90 }, "materials": { "wax": {} },
        "objects": [ { "id": 1, "shape": "sphere", "radius": 1, "material": "wax" } ],
        "lights": [ { "type": "point", "position": [1.5, 0.5, 1], "intensity": 5 } ] })");
    Capture capture = scene::SceneRenderer(scene, 64, 64, 2).render_capture(1);
    CaptureLight lamp;
    lamp.position_m = {1.5, 0.5, 1};
    lamp.intensity = {5, 5, 5};
    capture.header.lights = {lamp};
    const std::string params = burley({60, 30, 15});
    Image position = capture.images.at("position");
    capture.images.erase("position");
    std::erase(capture.header.roles, "position");
    const Image by_matrices = scattered(capture, params);
    EXPECT_GT(worst(capture, by_matrices, capture.images.at("irradiance"), 0), 0.02);
    capture.header.camera.camera_from_world.reset();
    const Image by_nothing = scattered(capture, params);
    EXPECT_LT(worst(capture, by_nothing, capture.images.at("irradiance"), 0), 1e-6);
    capture.images["position"] = std::move(position);
    capture.header.roles.push_back("position");
    const Image by_positions = scattered(capture, params);
    // Near the silhouette the normals' own bend is not known without the matrices.
    for (int y = 20; y < 44; ++y)
        for (int x = 20; x < 44; ++x)
            ASSERT_NEAR(by_positions.at(x, y, 0), by_matrices.at(x, y, 0), 0.015) << x << " " << y;
}

// ---- Into shadows

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
}  // namespace aftershade::test
