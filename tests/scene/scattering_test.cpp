// Scattered light against closed forms (reference: Christensen and Burley 2015; the line spread of the
// profile).
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "framework/scene/scatter_points.h"
#include "framework/scene/scene_reader.h"
#include "framework/scene/scene_renderer.h"
#include "tests/reference/burley.h"
#include "tests/scene/scene_text.h"
#include "tests/temporary_folder.h"

namespace aftershade::scene {
namespace {

using glm::dvec3;

constexpr double kPi = std::numbers::pi;

TEST(ScatterPoints, HaveRadiiThatInvertTheDistribution) {
    for (const double u : {0.001, 0.25, 0.5, 0.9, 0.99, 0.999}) {
        const double x = burley_radius(u);
        EXPECT_NEAR(1 - std::exp(-x) / 4 - 0.75 * std::exp(-x / 3), u, 1e-12);
    }
    EXPECT_NEAR(burley_radius(0.5), 1.5522, 1e-4);
}

TEST(ScatterPoints, StandForTheWholeProfileOfEveryChannel) {
    const Scattering scattering{dvec3(5e-3, 1e-3, 0.4e-3)};
    const std::vector<ScatterPoint> points = make_scatter_points(scattering, 3000);
    for (int c = 0; c < 3; ++c) {
        double sum = 0;
        for (const ScatterPoint& point : points)
            sum += burley_density(point.radius_m, scattering.d_m[c]) * point.area_m2;
        EXPECT_NEAR(sum, 1, 1e-3);
    }
}

TEST(ScatteringTruth, OfAnEdgeIsTheEdgeResponse) {
    const Scene scene = shipped_scene("plane_edge");
    const ScatteringTruth truth = SceneRenderer(scene, 480, 2, 2).render_scattering(1, {});
    double worst = 0;
    for (int x = 0; x < 480; ++x)
        for (int c = 0; c < 3; ++c) {
            // 666.7 px per unit of tangent at 5 m.
            const double x_m = (x + 0.5 - 240) / (480 * 50.0 / 36) * 5;
            const double expected =
                reference::burley_edge_response(x_m, scene.materials[0].scattering->d_m[c]);
            worst = std::max(worst, std::abs(double(truth.irradiance.at(x, 0, c)) - expected));
        }
    RecordProperty("worst", fmt::format("{:.5f}", worst));
    EXPECT_LT(worst, 0.005) << worst;
}

/// A plane close to the camera with half of it lit, made of `profile`.
Scene lit_half(const std::string& profile) {
    return scene_of(R"({ "aftershade": 1, "size": [480, 2],
        "camera": { "position": [0, 0, 0.05], "focal_length": "50 mm" },
        "materials": { "wax": { "albedo": 0.8, "specular": 0, "scattering_profile": )" +
                    profile + R"( } },
        "objects": [ { "shape": "plane", "size": [0.4, 0.4], "material": "wax" } ],
        "lights": [ { "type": "directional", "position": [0, 0, 1], "intensity": 3.14159265, "shadows": false,
                      "pattern": { "type": "edge", "axis": [1, 0, 0], "offset": 0 } } ] })");
}

/// What a lit half lets come out at x_mm into it: the Gaussians' own integral.
double edge_of_gaussians(const ScatteringProfile& profile, std::size_t c, double x_mm) {
    double light = x_mm > 0 ? profile.direct[c] : 0;
    for (const ScatteringGaussian& gaussian : profile.gaussians)
        light += gaussian.weight[c] * (0.5 + 0.5 * std::erf(x_mm / std::sqrt(2 * gaussian.variance_mm2[c])));
    return light;
}

TEST(ScatteringTruth, OfGaussiansAcrossAnEdgeIsTheSumOfErrorFunctions) {
    for (const std::string name : {"skin", "skin_artist"}) {
        const Scene scene = lit_half("\"" + name + "\"");
        const ScatteringTruth truth = SceneRenderer(scene, 480, 2, 2).render_scattering(1, {4096, false});
        double worst = 0;
        for (int x = 0; x < 480; ++x)
            for (std::size_t c = 0; c < 3; ++c) {
                const double x_mm = (x + 0.5 - 240) * 36 / 480;
                const double expected = edge_of_gaussians(scene.materials[0].scattering->profile, c, x_mm);
                worst = std::max(worst, std::abs(double(truth.irradiance.at(x, 0, int(c))) - expected));
            }
        RecordProperty("worst_" + name, fmt::format("{:.5f}", worst));
        EXPECT_LT(worst, 0.005) << name;
    }
}

TEST(ScatteringTruth, OfADipoleAcrossAnEdgeIsItsEdgeResponse) {
    const Scene scene = lit_half(R"({ "type": "dipole", "absorption_per_mm": [0.032, 0.17, 0.48],
                                      "reduced_scattering_per_mm": [0.74, 0.88, 1.01] })");
    const ScatteringTruth truth = SceneRenderer(scene, 480, 2, 2).render_scattering(1, {4096, false});
    const ScatteringProfile& profile = scene.materials[0].scattering->profile;
    const ScatteringCurves curves = scattering_curves(profile);
    double worst = 0;
    for (int i = 1; i < kScatteringSamples; ++i) {
        const double t = double(i) / (kScatteringSamples - 1), x_mm = profile.reach_mm() * t * t;
        const double at = x_mm * 480 / 36 + 240 - 0.5;
        if (at >= 479) break;
        for (int c = 0; c < 3; ++c) {
            const double between = std::lerp(double(truth.irradiance.at(int(at), 0, c)),
                                             double(truth.irradiance.at(int(at) + 1, 0, c)), at - int(at));
            worst = std::max(worst, std::abs(between - curves.line[std::size_t(i)][std::size_t(c)]));
        }
    }
    RecordProperty("worst", fmt::format("{:.5f}", worst));
    EXPECT_LT(worst, 0.005);
}

TEST(ScatteringTruth, TakesAProfilesFileFromTheScenesFolder) {
    const test::TemporaryFolder folder;
    test::write_text(folder / "wax.json",
                     R"({"aftershade": 1, "summary": "Wax.", "type": "burley", "d_mm": [3, 2, 1]})");
    test::write_text(folder / "scene.json", R"({"aftershade": 1, "camera": {}, "objects": [],
        "materials": {"wax": {"scattering_profile": "wax.json"}}})");
    Diagnostics diagnostics;
    const auto scene = read_scene(folder / "scene.json", diagnostics);
    ASSERT_TRUE(scene) << faults_of(diagnostics);
    EXPECT_EQ(scene->materials[0].scattering->d_m, dvec3(3, 2, 1) * 1e-3);
}

TEST(ScatteringTruth, OfACosineKeepsItWithTheProfilesModulation) {
    const Scene scene = shipped_scene("plane_cosine");
    const ScatteringTruth truth = SceneRenderer(scene, 480, 2, 2).render_scattering(1, {});
    for (int c = 0; c < 3; ++c) {
        const double w = 2 * kPi / 0.9, d_m = scene.materials[0].scattering->d_m[c];
        const double modulation = reference::burley_modulation(w, d_m);
        double worst = 0;
        for (int x = 0; x < 480; ++x) {
            const double x_m = (x + 0.5 - 240) / (480 * 50.0 / 36) * 5;
            const double expected = 1 + 0.8 * modulation * std::cos(2 * kPi * x_m / 0.9);
            worst = std::max(worst, std::abs(double(truth.irradiance.at(x, 1, c)) - expected));
        }
        RecordProperty(fmt::format("worst_{}", c), fmt::format("{:.5f} at M = {:.4f}", worst, modulation));
        EXPECT_LT(worst, 0.005) << "w d = " << w * d_m;
    }
}

TEST(ScatteringTruth, LeavesEvenLightAndWhatDoesNotScatterAsTheyAre) {
    for (const char* shape : {R"("shape": "plane", "size": [3, 3])", R"("shape": "sphere", "radius": 1)",
                              R"("shape": "box", "size": [2, 2, 2], "rotation": [20, 30, 0])",
                              R"("shape": "sphere", "radius": 1, "scale": [1, 0.5, 0.8])",
                              R"("shape": "mesh", "mesh": "waves")"}) {
        const Scene scene = scene_of(fmt::format(R"({{ "aftershade": 1, "size": [48, 27], "ambient": 0.7,
            "camera": {{ "position": [0, 0, 6] }},
            "materials": {{ "wax": {{ "albedo": 0.8, "scattering_profile": {{ "type": "burley", "d_mm": [90, 30, 10] }} }} }},
            "meshes": {{ "waves": {{ "height_field": {{ "size": [3, 3], "segments": 32,
                         "waves": [ {{ "amplitude": 0.1, "cycles": [0.7, 0.3] }} ] }} }} }},
            "objects": [ {{ {}, "material": "wax" }} ] }})",
                                                 shape));
        const ScatteringTruth truth = SceneRenderer(scene, 48, 27, 2).render_scattering(1, {256, false});
        for (int x = 0; x < 48; ++x) {
            const float light = truth.irradiance.at(x, 13, 0);
            ASSERT_TRUE(light == 0 || std::abs(light - 0.7f) < 1e-5f) << shape << " " << light;
        }
        ASSERT_NEAR(truth.irradiance.at(24, 13, 1), 0.7, 1e-5) << shape;
    }
}

/// The same integral by another way: a fine grid over the surface's own coordinates.
struct GridSum {
    dvec3 light{0}, weight{0};
    void add(const dvec3& at, const dvec3& position, double area_m2, double irradiance, const dvec3& d_m) {
        for (int c = 0; c < 3; ++c) {
            const double share =
                burley_density(std::max(glm::distance(at, position), 1e-9), d_m[c]) * area_m2;
            light[c] += share * irradiance;
            weight[c] += share;
        }
    }
    dvec3 mean() const { return light / weight; }
};

TEST(ScatteringTruth, OnASphereIsTheSurfaceIntegral) {
    const Scene scene = scene_of(
        R"({ "aftershade": 1, "size": [41, 41], "camera": { "position": [0, 0, 6], "focal_length": 90 },
        "materials": { "wax": { "albedo": 0.8, "specular": 0, "scattering_profile": { "type": "burley", "d_mm": [200, 100, 50] } } },
        "objects": [ { "shape": "sphere", "radius": 1, "material": "wax" } ],
        "lights": [ { "type": "directional", "position": [1, 0, 0], "intensity": 3.14159265 } ] })");
    const SceneRenderer renderer(scene, 41, 41, 2);
    const ScatteringTruth truth = renderer.render_scattering(1, {4096, false});
    const Capture capture = renderer.render_capture(1);
    for (const int x : {10, 17, 20, 24, 31}) {
        dvec3 at;
        for (int c = 0; c < 3; ++c) at[c] = capture.images.at("position").at(x, 20, c);
        GridSum sum;
        constexpr int kRows = 1500;
        for (int i = 0; i < kRows; ++i) {
            const double polar = (i + 0.5) / kRows * kPi;
            for (int j = 0; j < 2 * kRows; ++j) {
                const double round = (j + 0.5) / kRows * kPi;
                const dvec3 p(std::sin(polar) * std::cos(round), std::cos(polar),
                              std::sin(polar) * std::sin(round));
                sum.add(at, p, std::sin(polar) * kPi / kRows * kPi / kRows, std::max(p.x, 0.0),
                        {0.2, 0.1, 0.05});
            }
        }
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(truth.irradiance.at(x, 20, c), sum.mean()[c], 0.005) << x;
    }
}

/// Where the profile is narrow against the room, scattered light is nearly the light that came in.
TEST(ScatteringTruth, InsideASphereIsOfTheWallThatThePixelShows) {
    const Scene scene = scene_of(
        R"({ "aftershade": 1, "size": [21, 21], "camera": { "position": [0, 0, 0] },
        "materials": { "wax": { "scattering_profile": { "type": "burley", "d_mm": [1, 2, 3] } } },
        "objects": [ { "shape": "sphere", "radius": 1, "material": "wax" } ],
        "lights": [ { "type": "point", "position": [0.2, 0, -0.5], "intensity": 3 } ] })");
    const SceneRenderer renderer(scene, 21, 21, 1);
    const ScatteringTruth truth = renderer.render_scattering(1, {512, false});
    const Capture capture = renderer.render_capture(1);
    for (int x = 0; x < 21; ++x) {
        const float light = capture.images.at("irradiance").at(x, 10, 0);
        ASSERT_GT(light, 0);
        EXPECT_NEAR(truth.irradiance.at(x, 10, 0), light, 0.01 * light) << x;
    }
}

/// Sheared by its parent, a ball is none any more, though its axes can keep one length.
TEST(ScatteringTruth, OnAShearedBallGoesByItsSurface) {
    const auto middle_of = [](double depth) {
        const Scene scene = scene_of(fmt::format(
            R"({{ "aftershade": 1, "size": [31, 31], "camera": {{ "position": [0, 0, 8] }},
            "materials": {{ "wax": {{ "scattering_profile": {{ "type": "burley", "d_mm": [300, 200, 100] }} }} }},
            "objects": [ {{ "name": "squeeze", "shape": "group", "scale": [2, 1, {:.17g}] }},
                         {{ "shape": "sphere", "radius": 0.5, "material": "wax", "parent": "squeeze",
                            "rotation": [0, 0, 45] }} ],
            "lights": [ {{ "type": "directional", "position": [2, 0, 1], "intensity": 3 }} ] }})",
            depth));
        const ScatteringTruth truth = SceneRenderer(scene, 31, 31, 1).render_scattering(1, {1024, false});
        return truth.irradiance.at(13, 15, 0);
    };
    EXPECT_NEAR(middle_of(std::sqrt(2.5)), middle_of(std::sqrt(2.5) * (1 + 1e-6)), 1e-3);
}

void add_box(Mesh& mesh, const dvec3& low, const dvec3& high) {
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {0, 1}) {
            dvec3 normal(0), right(0), up(0);
            normal[axis] = side * 2 - 1;
            right[(axis + 1) % 3] = normal[axis] * (high - low)[(axis + 1) % 3];
            up[(axis + 2) % 3] = (high - low)[(axis + 2) % 3];
            const dvec3 middle = 0.5 * (low + high) + 0.5 * normal * (high - low);
            const auto first = std::uint32_t(mesh.vertices.size());
            for (const dvec3& corner : {-right - up, right - up, right + up, -right + up})
                mesh.vertices.push_back({middle + 0.5 * corner, normal, {}});
            mesh.triangles.push_back({first, first + 1, first + 2});
            mesh.triangles.push_back({first, first + 2, first + 3});
        }
}

/// A slab with a block over it: lines along the slab's normal begin inside the block. What looks up is lit.
TEST(ScatteringTruth, KnowsOutsideFromInsideWhereALineBeginsInTheObject) {
    Scene scene = scene_of(
        R"({ "aftershade": 1, "size": [3, 3], "camera": { "position": [0, 5, 0] },
        "materials": { "wax": { "scattering_profile": { "type": "burley", "d_mm": [200, 150, 100] } } },
        "meshes": { "blocks": { "height_field": { "size": [1, 1] } } },
        "objects": [ { "shape": "mesh", "mesh": "blocks", "material": "wax" } ],
        "lights": [ { "type": "directional", "position": [0, 1, 0], "intensity": 3.14159265, "shadows": false } ] })");
    Mesh& mesh = scene.meshes[0] = Mesh{};
    add_box(mesh, {-5, -0.2, -5}, {5, 0, 5});
    add_box(mesh, {0.3, 0.05, -5}, {5, 40, 5});
    const ScatteringTruth truth = SceneRenderer(scene, 3, 3, 1).render_scattering(1, {8192, false});
    GridSum sum;
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k) {
            const double r = (i + 0.5) / kSteps * 5, angle = (k + 0.5) / kSteps * 2 * kPi;
            const double area = r * 5 / kSteps * 2 * kPi / kSteps;
            const dvec3 p(r * std::cos(angle), 0, r * std::sin(angle)), d_m(0.2, 0.15, 0.1);
            sum.add(dvec3(0), p, area, 1, d_m);
            // Lines reach three radii to both sides.
            if (3 * r > 0.2) sum.add(dvec3(0), p + dvec3(0, -0.2, 0), area, 0, d_m);
            if (p.x > 0.3) sum.add(dvec3(0), p + dvec3(0, 0.05, 0), area, 0, d_m);
        }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(truth.irradiance.at(1, 1, c), sum.mean()[c], 0.01) << c;
}

/// Half a pixel to the right is the next pixel's left edge, whichever of the two says so.
TEST(ScatteringTruth, IsJitteredAsTheCaptureIs) {
    const Scene scene = shipped_scene("plane_edge");
    const SceneRenderer renderer(scene, 48, 2, 1);
    const ScatteringTruth right = renderer.render_scattering(1, {512, true, {0.5, 0}}),
                          left = renderer.render_scattering(1, {512, true, {-0.5, 0}});
    for (int x = 0; x + 1 < 48; ++x)
        EXPECT_NEAR(right.irradiance.at(x, 0, 0), left.irradiance.at(x + 1, 0, 0), 1e-6) << x;
}

TEST(ScatteringTruth, OnAHeightFieldIsTheSurfaceIntegral) {
    const Scene scene = scene_of(
        R"({ "aftershade": 1, "size": [41, 41], "camera": { "position": [0, 0, 6], "focal_length": 60 },
        "materials": { "wax": { "albedo": 0.8, "specular": 0, "scattering_profile": { "type": "burley", "d_mm": [120, 80, 50] } } },
        "meshes": { "waves": { "height_field": { "size": [6, 6], "segments": 256,
                    "waves": [ { "amplitude": 0.12, "cycles": [0.8, 0] }, { "amplitude": 0.05, "cycles": [0.3, 1.1], "phase": 40 } ] } } },
        "objects": [ { "shape": "mesh", "mesh": "waves", "material": "wax" } ],
        "lights": [ { "type": "directional", "position": [1, 0, 1.2], "intensity": 3.14159265, "shadows": false } ] })");
    const SceneRenderer renderer(scene, 41, 41, 2);
    const ScatteringTruth truth = renderer.render_scattering(1, {4096, false});
    const Capture capture = renderer.render_capture(1);
    const dvec3 toward = glm::normalize(dvec3(1, 0, 1.2));
    const auto gradient = [](double x, double y) {
        const double a = 2 * kPi * 0.8 * x, b = 2 * kPi * (0.3 * x + 1.1 * y) + 40 * kPi / 180;
        return dvec3(-0.12 * std::sin(a) * 2 * kPi * 0.8 - 0.05 * std::sin(b) * 2 * kPi * 0.3,
                     -0.05 * std::sin(b) * 2 * kPi * 1.1, 0.12 * std::cos(a) + 0.05 * std::cos(b));
    };
    for (const int x : {6, 13, 20, 26, 33}) {
        dvec3 at;
        for (int c = 0; c < 3; ++c) at[c] = capture.images.at("position").at(x, 20, c);
        GridSum sum;
        constexpr int kCells = 2000;
        for (int i = 0; i < kCells; ++i)
            for (int j = 0; j < kCells; ++j) {
                const double px = (i + 0.5) / kCells * 6 - 3, py = (j + 0.5) / kCells * 6 - 3;
                const dvec3 slope = gradient(px, py);
                const dvec3 normal(-slope.x, -slope.y, 1);
                const double stretch = glm::length(normal);
                sum.add(at, {px, py, slope.z}, stretch * 36.0 / kCells / kCells,
                        std::max(glm::dot(normal, toward) / stretch, 0.0), {0.12, 0.08, 0.05});
            }
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(truth.irradiance.at(x, 20, c), sum.mean()[c], 0.01) << x << " " << c;
    }
}

}  // namespace
}  // namespace aftershade::scene
