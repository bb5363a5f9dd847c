// Captures against closed forms and against each other.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "framework/scene/scene_renderer.h"
#include "tests/scene/scene_text.h"

namespace aftershade::scene {
namespace {

using glm::dmat4;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

dvec3 rgb(const Image& image, int x, int y) {
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

/// What a surface's pixel was in its object's own space.
dvec3 local_of(const SceneState& state, int object, const dvec3& world) {
    return dvec3(glm::inverse(state.world_from_object[std::size_t(object)]) * dvec4(world, 1));
}

TEST(Gbuffer, OfAPlaneAndASphereIsTheirClosedForm) {
    // 100 px per unit of tangent: the sphere's silhouette is where the tangent of its angle is r / sqrt(d^2 -
    // r^2).
    const Scene scene = scene_of(R"({ "aftershade": 1, "size": [200, 100],
        "camera": { "position": [0, 0, 10], "focal_length": 18, "sensor_width": 36 },
        "background": 0.5, "materials": { "grey": { "albedo": 0.5, "specular": 0 } },
        "objects": [ { "id": 4, "shape": "sphere", "radius": 2, "material": "grey" },
                     { "id": 9, "shape": "plane", "size": [100, 6], "position": [0, 0, -5], "material": "grey" } ],
        "lights": [ { "type": "directional", "position": [0, 0, 1], "intensity": 6, "shadows": false } ] })");
    const Capture capture = SceneRenderer(scene, 200, 100, 2).render_capture(1);
    const double silhouette_px = 100 * 2 / std::sqrt(100.0 - 4.0);
    int wrong = 0;
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 200; ++x) {
            const dvec2 tangent = dvec2(x + 0.5 - 100, 50 - y - 0.5) / 100.0;
            const double to_axis_px = glm::length(tangent) * 100;
            const bool on_plane = std::abs(tangent.y) * 15 < 3;
            const unsigned id = to_axis_px < silhouette_px ? 4 : on_plane ? 9 : 0;
            wrong += capture.images.at("object_id").uint_at(x, y, 0) != id;
            const float depth = capture.images.at("depth").at(x, y, 0);
            if (id == 9) {
                ASSERT_FLOAT_EQ(depth, 15);
                ASSERT_LT(glm::distance(rgb(capture.images.at("position"), x, y), dvec3(tangent * 15.0, -5)),
                          1e-5);
                ASSERT_EQ(rgb(capture.images.at("normal"), x, y), dvec3(0, 0, 1));
                // E = 6 head on; the role is E / pi.
                ASSERT_NEAR(capture.images.at("irradiance").at(x, y, 0), 6 / std::acos(-1), 1e-6);
            } else if (id == 4) {
                const dvec3 position = rgb(capture.images.at("position"), x, y);
                ASSERT_NEAR(glm::length(position), 2, 1e-6);
                ASSERT_NEAR(depth, 10 - position.z, 1e-5);
                ASSERT_LT(glm::distance(rgb(capture.images.at("normal"), x, y), position / 2.0), 1e-6);
            } else {
                ASSERT_EQ(depth, std::numeric_limits<float>::infinity());
                ASSERT_EQ(capture.images.at("color").at(x, y, 0), 0.5f);
            }
        }
    EXPECT_EQ(wrong, 0);
}

TEST(Gbuffer, MovesAsObjectsAndCameraDo) {
    // 1000 px per unit of tangent. The box moves 0.1 m to the right and 0.05 m up a frame at a depth of 9.9
    // m, the camera 0.02 m to the right.
    const Scene scene = scene_of(R"({ "aftershade": 1, "size": [100, 50],
        "camera": { "position": { "keys": { "0": [0, 0, 10], "10": [0.2, 0, 10] } },
                    "target": { "keys": { "0": [0, 0, 0], "10": [0.2, 0, 0] } }, "focal_length": 360, "sensor_width": 36 },
        "materials": { "grey": {} },
        "objects": [ { "shape": "box", "size": [0.3, 0.2, 0.2], "material": "grey",
                       "position": { "keys": { "0": [-0.5, -0.25, 0], "10": [0.5, 0.25, 0] } } } ] })");
    const Capture capture = SceneRenderer(scene, 100, 50, 1).render_capture(5);
    const Image &velocity = capture.images.at("velocity"), &next = capture.images.at("velocity_next");
    // The box is at (0, 0), the camera at x = 0.1: the box's front is 10.1 px left of the middle.
    ASSERT_NE(capture.images.at("object_id").uint_at(40, 25, 0), 0u);
    EXPECT_NEAR(velocity.at(40, 25, 0), 1000 * 0.08 / 9.9, 1e-4);
    EXPECT_NEAR(velocity.at(40, 25, 1), -1000 * 0.05 / 9.9, 1e-4);
    EXPECT_NEAR(next.at(40, 25, 0), 1000 * 0.08 / 9.9, 1e-4);
    // Infinitely far away only the camera's turning counts.
    ASSERT_EQ(capture.images.at("object_id").uint_at(90, 5, 0), 0u);
    EXPECT_NEAR(velocity.at(90, 5, 0), 0, 1e-6);
}

TEST(Gbuffer, KeepsVelocityApartFromJitter) {
    const Scene scene = shipped_scene("moving_box");
    const SceneRenderer renderer(scene, 96, 54, 1);
    const Capture still = renderer.render_capture(8), jittered = renderer.render_capture(8, 8, {0.4, -0.3});
    const Image &a = still.images.at("velocity"), &b = jittered.images.at("velocity");
    int compared = 0;
    for (int y = 0; y < 54; ++y)
        for (int x = 0; x < 96; ++x) {
            if (still.images.at("object_id").uint_at(x, y, 0) !=
                jittered.images.at("object_id").uint_at(x, y, 0))
                continue;
            ASSERT_NEAR(a.at(x, y, 0), b.at(x, y, 0), 1e-3);
            ASSERT_NEAR(a.at(x, y, 1), b.at(x, y, 1), 1e-3);
            ++compared;
        }
    EXPECT_GT(compared, 5000);
}

TEST(Gbuffer, KnowsNothingOfTheShotBeforeACut) {
    const std::string text = R"({ "aftershade": 1, "size": [60, 20], "cuts": [3],
        "camera": { "position": [0, 0, 10], "focal_length": 60 }, "materials": { "grey": {} },
        "objects": [ { "shape": "box", "size": 2, "material": "grey",
            "position": { "keys": { "1": [-1, 0, 0], "2": [-0.5, 0, 0], "3": [0.5, 0, 0], "4": [0.6, 0, 0] } } } ] })";
    const Scene scene = scene_of(text);
    const SceneRenderer renderer(scene, 60, 20, 1);
    // 100 px per unit of tangent, the front at 9 m: 0.1 m a frame after the cut, 0.5 m before it.
    const Capture after = renderer.render_capture(3), before = renderer.render_capture(2);
    EXPECT_NEAR(after.images.at("velocity").at(35, 10, 0), 100 * 0.1 / 9, 1e-4);
    EXPECT_NEAR(before.images.at("velocity_next").at(25, 10, 0), 100 * 0.5 / 9, 1e-4);
}

class EveryScene : public testing::TestWithParam<std::string> {
protected:
    Scene scene_ = shipped_scene(GetParam());
    int middle_ = scene_.frames[scene_.frames.size() / 2];
};

TEST_P(EveryScene, HasColorThatIsTheSumOfItsParts) {
    // Through a transparent surface comes light that is not of its own parts: that surface opaque.
    for (Material& material : scene_.materials) material.opacity = 1;
    const Capture capture = SceneRenderer(scene_, 240, 135, 2).render_capture(middle_);
    double worst = 0;
    for (int y = 0; y < 135; ++y)
        for (int x = 0; x < 240; ++x) {
            const dvec3 sum =
                rgb(capture.images.at("albedo"), x, y) * rgb(capture.images.at("irradiance"), x, y) +
                rgb(capture.images.at("specular"), x, y) + rgb(capture.images.at("emission"), x, y);
            const dvec3 color = rgb(capture.images.at("color"), x, y);
            for (int c = 0; c < 3; ++c)
                worst = std::max(worst, std::abs(color[c] - sum[c]) / std::max(1.0, std::abs(color[c])));
        }
    EXPECT_LT(worst, 1e-5);
}

/// Warps the frame before by the velocity, and asks by how much the point that comes is another one: both are
/// brought to their object's space, with matrices that the renderer's own projection has no part in.
TEST_P(EveryScene, HasVelocityThatFindsThePointInTheFrameBefore) {
    constexpr int kWidth = 480, kHeight = 270;
    const SceneRenderer renderer(scene_, kWidth, kHeight, 2);
    const int frame = scene_.frames.size() > 1 ? middle_ : 1;
    const Capture now = renderer.render_capture(frame), then = renderer.render_capture(frame - 1);
    const SceneState state = state_at(scene_, frame, frame),
                     state_then = state_at(scene_, frame - 1, frame - 1);
    std::map<unsigned, std::vector<int>> objects_of;
    for (std::size_t i = 0; i < scene_.objects.size(); ++i)
        if (scene_.objects[i].shape.kind != ShapeKind::group)
            objects_of[scene_.objects[i].id].push_back(int(i));
    const CameraMatrix& view_then = *then.header.camera.camera_from_world;
    const double px_per_tangent =
        scene_.camera.focal_length_mm.at(frame) * kWidth / scene_.camera.sensor_width_mm;
    int visible = 0, off = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const unsigned id = now.images.at("object_id").uint_at(x, y, 0);
            if (id == 0) continue;
            const dvec2 at(x - double(now.images.at("velocity").at(x, y, 0)),
                           y - double(now.images.at("velocity").at(x, y, 1)));
            const int x0 = int(std::floor(at.x)), y0 = int(std::floor(at.y));
            if (x0 < 0 || y0 < 0 || x0 + 1 >= kWidth || y0 + 1 >= kHeight) continue;
            const dvec2 part = at - dvec2(x0, y0);
            // Where the four texels lie apart there is an edge between them, and nothing to interpolate.
            const double apart_m = 4 * double(now.images.at("depth").at(x, y, 0)) / px_per_tangent;
            const dvec3 corner = rgb(then.images.at("position"), x0, y0);
            dvec3 found(0);
            bool whole = true;
            for (int k = 0; k < 4; ++k) {
                const int cx = x0 + (k & 1), cy = y0 + (k >> 1);
                whole &= then.images.at("object_id").uint_at(cx, cy, 0) == id;
                whole &= glm::distance(corner, rgb(then.images.at("position"), cx, cy)) < apart_m;
                found += ((k & 1) ? part.x : 1 - part.x) * ((k >> 1) ? part.y : 1 - part.y) *
                         rgb(then.images.at("position"), cx, cy);
            }
            if (!whole) continue;
            double nearest_px = 1e9;
            bool is_seen = false;
            for (const int object : objects_of[id]) {
                const dvec3 local = local_of(state, object, rgb(now.images.at("position"), x, y));
                const dvec3 was(state_then.world_from_object[std::size_t(object)] * dvec4(local, 1));
                const double depth =
                    -(view_then[8] * was.x + view_then[9] * was.y + view_then[10] * was.z + view_then[11]);
                is_seen |=
                    std::abs(depth - double(then.images.at("depth").at(
                                         int(std::lround(at.x)), int(std::lround(at.y)), 0))) < 0.01 * depth;
                nearest_px = std::min(nearest_px, glm::distance(was, found) / depth * px_per_tangent);
            }
            if (!is_seen) continue;
            ++visible;
            off += nearest_px > 0.5;
        }
    if (GetParam() != "point_grid" && GetParam() != "bats") {
        EXPECT_GT(visible, 20000);
    }
    RecordProperty("visible_px", visible);
    RecordProperty("off_px", off);
    EXPECT_LE(off, 0.01 * visible) << off << " of " << visible;
}

INSTANTIATE_TEST_SUITE_P(Shipped, EveryScene, testing::ValuesIn(shipped_scenes()),
                         [](const auto& scene) { return scene.param; });

TEST(Gbuffer, HasTheSameBitsWhateverTheThreads) {
    const Scene scene = shipped_scene("wheel");
    for (int frame = 1; frame <= 24; ++frame) {
        const Capture a = SceneRenderer(scene, 96, 54, 1).render_capture(frame);
        const Capture b = SceneRenderer(scene, 96, 54, 3).render_capture(frame);
        for (const auto& [role, image] : a.images) {
            const Image& other = b.images.at(role);
            if (image.type() == ComponentType::float32)
                ASSERT_TRUE(std::equal(image.floats().begin(), image.floats().end(), other.floats().begin()))
                    << role.name();
            else
                ASSERT_TRUE(std::equal(image.uints().begin(), image.uints().end(), other.uints().begin()))
                    << role.name();
        }
    }
}

}  // namespace
}  // namespace aftershade::scene
