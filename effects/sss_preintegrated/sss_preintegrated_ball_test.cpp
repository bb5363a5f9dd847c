// Scattering by lookup over the terminator: on balls against the integrals in double and the renderer's
// scattering.
#include <cstring>

#include <gtest/gtest.h>

#include "effects/sss_preintegrated/sss_preintegrated_test.h"

namespace aftershade::test::preintegrated {
namespace {

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
            // The ring is not part of a ball's surface, and Burley's profile is none for a line.
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

}  // namespace
}  // namespace aftershade::test::preintegrated
