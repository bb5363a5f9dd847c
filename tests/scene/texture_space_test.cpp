// Captures over an object's texture coordinates.
#include <cmath>

#include <gtest/gtest.h>

#include "framework/scene/scene_renderer.h"
#include "framework/scene/surface_map.h"
#include "tests/scene/scene_text.h"

namespace aftershade::scene {
namespace {

using glm::dvec2;
using glm::dvec3;

/// What the picture shows at a pixel, the texture has where the surface's uv say.
TEST(TextureSpace, HasTheLightThatThePictureShows) {
    const Scene scene = scene_of(
        R"({ "aftershade": 1, "size": [160, 90], "camera": { "position": [1, 1.5, 5] }, "ambient": 0.1,
        "materials": { "clay": { "albedo": 0.6 } },
        "objects": [ { "name": "ball", "shape": "sphere", "radius": 1, "material": "clay", "rotation": [10, 40, 0] },
                     { "shape": "plane", "size": [6, 4], "position": [0, 0, -1.5], "material": "clay" } ],
        "lights": [ { "type": "point", "position": [2, 3, 4], "intensity": 20 } ] })");
    const SceneRenderer renderer(scene, 160, 90, 2);
    const Capture picture = renderer.render_capture(1), texture = renderer.render_texture_space(1, 0, 512);
    const SceneState state = state_at(scene, 1, 1);
    int compared = 0;
    for (int y = 0; y < 90; ++y)
        for (int x = 0; x < 160; ++x) {
            if (picture.images.at("object_id").uint_at(x, y, 0) != 1) continue;
            dvec3 position;
            for (int c = 0; c < 3; ++c) position[c] = picture.images.at("position").at(x, y, c);
            const dvec3 local(glm::inverse(state.world_from_object[0]) * glm::dvec4(position, 1));
            const double turn = std::atan2(local.z, local.x) / (2 * std::acos(-1.0));
            const int u = int((turn - std::floor(turn)) * 512),
                      v = int(std::acos(local.y) / std::acos(-1.0) * 512);
            ASSERT_NEAR(texture.images.at("irradiance").at(u, v, 0),
                        picture.images.at("irradiance").at(x, y, 0), 0.01);
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(texture.images.at("position").at(u, v, c), position[c], 0.02);
            ++compared;
        }
    EXPECT_GT(compared, 1000);
    EXPECT_FALSE(texture.images.contains("depth"));
    EXPECT_EQ(texture.images.at("object_id").uint_at(7, 300, 0), 1u);
}

/// The renderer's uv of each mapped point is the texel that it came from.
TEST(TextureSpace, AgreesWithTheUvThatCheckersUse) {
    for (const ShapeKind kind :
         {ShapeKind::plane, ShapeKind::disk, ShapeKind::sphere, ShapeKind::box, ShapeKind::cylinder}) {
        Shape shape;
        shape.kind = kind;
        shape.half_size_m =
            kind == ShapeKind::sphere || kind == ShapeKind::disk ? dvec3(0.7) : dvec3(0.7, 0.4, 0.7);
        constexpr int kSide = 48;
        const SurfaceMap map = make_surface_map(shape, nullptr, kSide);
        int covered = 0;
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                if (map.position.at(x, y, 3) == 0) continue;
                ++covered;
                dvec3 position, normal;
                for (int c = 0; c < 3; ++c) {
                    position[c] = map.position.at(x, y, c);
                    normal[c] = map.normal.at(x, y, c);
                }
                // From outside onto the point.
                const Ray ray{position + normal, -normal};
                ShapeHit hit;
                ASSERT_TRUE(intersect(shape, nullptr, ray, 0, 10, false, hit));
                const ShapePoint point = point_of(shape, nullptr, ray, hit);
                ASSERT_NEAR(hit.t, 1, 1e-6);
                ASSERT_LT(glm::distance(point.normal, normal), 1e-6);
                ASSERT_LT(glm::distance(point.uv, dvec2(x + 0.5, y + 0.5) / double(kSide)), 1e-4)
                    << int(kind) << " " << x << " " << y << ": " << point.uv.x << " " << point.uv.y;
            }
        EXPECT_GT(covered, kSide * kSide / 2);
    }
}

}  // namespace
}  // namespace aftershade::scene
