// Light at the edges: horizons, lights that touch what they light, shots that begin as something moves.
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "framework/scene/scene_renderer.h"
#include "tests/scene/scene_text.h"

namespace aftershade::scene {
namespace {

/// A ball alone shadows nothing but what the horizon cuts off already.
TEST(AreaLight, IsNotHiddenFromABallByTheBallItself) {
    for (const int samples : {1, 4}) {
        const auto scene_with = [&](bool shadows) {
            return scene_of(fmt::format(R"({{ "aftershade": 1, "size": [41, 41],
                "camera": {{ "position": [0, 0, 6], "focal_length": 90 }}, "materials": {{ "clay": {{}} }},
                "objects": [ {{ "shape": "sphere", "radius": 1, "material": "clay" }} ],
                "lights": [ {{ "type": "area", "position": [4, 0, 0], "size": [3, 3], "shadows": {},
                               "shadow_samples": {} }} ] }})",
                                        shadows, samples));
        };
        const Scene with = scene_with(true), without = scene_with(false);
        const Capture a = SceneRenderer(with, 41, 41, 1).render_capture(1),
                      b = SceneRenderer(without, 41, 41, 1).render_capture(1);
        int beyond = 0;  // pixels where the light's middle is below the horizon and some of it above
        for (int y = 0; y < 41; ++y)
            for (int x = 0; x < 41; ++x) {
                const float light = b.images.at("irradiance").at(x, y, 0);
                ASSERT_NEAR(a.images.at("irradiance").at(x, y, 0), light, 1e-6) << x << " " << y;
                beyond += light > 0 && b.images.at("position").at(x, y, 0) < 0.25 ? 1 : 0;
            }
        EXPECT_GT(beyond, 20);
    }
}

TEST(Light, ThatTouchesASurfaceGivesItNoNan) {
    for (const char* type : {R"("type": "point")", R"("type": "area", "target": [0, 1, 0])"}) {
        const Scene scene = scene_of(fmt::format(R"({{ "aftershade": 1, "camera": {{ "position": [0, 0, 3] }},
            "materials": {{ "clay": {{}} }},
            "objects": [ {{ "shape": "plane", "size": [2, 2], "material": "clay" }} ],
            "lights": [ {{ "position": [0, 0, 0], {} }} ] }})",
                                                 type));
        const Capture capture = SceneRenderer(scene, 3, 3, 1).render_capture(1);
        for (const float value : capture.images.at("color").floats())
            EXPECT_TRUE(std::isfinite(value)) << type;
    }
}

/// The ambient light at the origin of a floor, seen from above, with `objects` around it.
double ambient_at_floor(const std::string& objects, const glm::dvec3& eye) {
    const Scene scene = scene_of(fmt::format(R"({{ "aftershade": 1, "camera": {{ "position": [0, 0, 3] }},
        "ambient": 1, "ambient_rays": 1024, "materials": {{ "clay": {{}} }}, "objects": [ {}
        {{ "shape": "plane", "size": [2000, 2000], "rotation": [-90, 0, 0], "material": "clay" }} ] }})",
                                             objects));
    const SceneRenderer renderer(scene, 1, 1, 1);
    const World world = renderer.world_at(1, 1);
    return world.irradiance(*world.trace({eye, -eye}, 0.5, 2)).x;
}

/// The form factors of a strip and of a ball from a point (Howell, A Catalog of Radiation Heat Transfer
/// Configuration Factors, B-7 and B-42).
TEST(AmbientRays, FindTheShareThatAWallABallAndAShellHide) {
    const double height_m = 2, distance_m = 1.5;
    EXPECT_NEAR(ambient_at_floor(R"({ "shape": "plane", "size": [4000, 4], "position": [0, 0, -1.5],
                                      "material": "clay" },)",
                                 {0, 1, 1}),
                (1 + std::cos(std::atan2(height_m, distance_m))) / 2, 0.004);
    EXPECT_NEAR(
        ambient_at_floor(R"({ "shape": "sphere", "radius": 1, "position": [0, 2, 0], "material": "clay" },)",
                         {0.1, 0.2, 0.9}),
        1 - 1.0 / 4, 0.004);
    EXPECT_EQ(ambient_at_floor(R"({ "shape": "sphere", "radius": 3, "material": "clay" },)", {0, 1, 1}), 0);
    EXPECT_EQ(ambient_at_floor("", {0, 1, 1}), 1);
}

TEST(AmbientRays, PassWhatCastsNoShadow) {
    EXPECT_EQ(
        ambient_at_floor(R"({ "shape": "sphere", "radius": 3, "material": "clay", "casts_shadow": false },)",
                         {0, 1, 1}),
        1);
}

/// Before a cut the curves of frame 1 go on backwards: a straight line would pass 0 within the shutter.
TEST(FirstFrameOfAShot, KeepsWhatIsPositiveAboveZero) {
    const Scene scene = scene_of(R"({ "aftershade": 1, "cuts": [1], "shutter": { "angle": 360 },
        "camera": { "focal_length": { "keys": { "1": 10, "2": 50 } },
                    "focus_distance": { "keys": { "1": 1, "2": 9 } } },
        "objects": [ { "shape": "group", "scale": { "keys": { "1": [1, 1, 0.1], "2": [3, 2, 1] } } } ],
        "lights": [ { "type": "point", "position": [0, 1, 0], "intensity": { "keys": { "1": 0, "2": 100 } } } ] })");
    for (const double time : {0.0, 0.5, 0.75}) {
        const SceneState state = state_at(scene, 1, time);
        EXPECT_GT(state.camera.focal_length_mm, 0) << time;
        EXPECT_GT(state.camera.focus_distance_m, 0) << time;
        for (int axis = 0; axis < 3; ++axis) EXPECT_GT(state.world_from_object[0][axis][axis], 0) << time;
        EXPECT_GE(state.lights[0].color_intensity.x, 0) << time;
    }
    // Its speed at the cut is that inside the shot: 40 mm a frame.
    const auto focal_mm = [&](double time) { return state_at(scene, 1, time).camera.focal_length_mm; };
    EXPECT_NEAR((focal_mm(1) - focal_mm(1 - 1e-6)) / 1e-6, 40, 1e-3);
}

}  // namespace
}  // namespace aftershade::scene
