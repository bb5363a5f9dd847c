// Scenes and files that are allowed but unusual.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "framework/image/srgb.h"
#include "framework/scene/triangulate.h"
#include "framework/scene/visibility.h"
#include "tests/scene/textured_file.h"
#include "tests/scene/with_samples.h"

namespace aftershade::scene {
namespace {

using namespace test;

TEST(OddScenes, WithTheCameraInATrianglesPlaneHaveFiniteLight) {
    // The middle of the lens lies on the floor and sees no point of it but itself; other points of the lens
    // do.
    const Scene scene = triangulated(scene_of(R"({ "aftershade": 1, "size": [24, 16],
        "camera": { "position": [0, 0, 0], "target": [0, 0, -1], "focus_distance": 4, "f_number": 2 },
        "materials": { "shiny": { "albedo": 0.5, "specular": 0.3 } },
        "lights": [ { "type": "directional", "position": [1, 2, 3], "intensity": 2 } ],
        "objects": [ { "shape": "plane", "size": [6, 6], "rotation": [-90, 0, 0], "material": "shiny" } ] })"));
    const Image color = render_visibility(SceneRenderer(scene, 24, 16, 1), 1, with_samples(4)).color;
    EXPECT_TRUE(std::ranges::all_of(color.floats(), [](float value) { return std::isfinite(value); }));
    EXPECT_GT(*std::ranges::max_element(color.floats()), 0.1f);
}

TEST(OddScenes, MayHaveTexturesAndBuffersWithPlusSignsInTheirNames) {
    const TemporaryFolder folder;
    write_text(folder / "oak+a nail.png", png_of({200, 100, 50}));
    write_text(folder / "oak a nail.png", png_of({1, 2, 3}));
    const File file = textured_quad(kPainted, {.images = R"({"uri": "oak+a%20nail.png"})"});
    write_text(folder / "model.gltf", file.json("a+b.bin"));
    write_text(folder / "a+b.bin", file.buffer());
    const Scene scene = quad_scene(folder.path(), 2);
    const Capture capture = SceneRenderer(scene, 2, 2, 1).render_capture(1);
    EXPECT_NEAR(pixel_of(capture, "albedo", 0, 0).x, decode_srgb(200 / 255.0), 1e-5);
}

TEST(OddScenes, WithAMeshThatCannotBeReadHaveOneFault) {
    const TemporaryFolder folder;
    write_text(folder / "model.gltf", "{");
    write_text(folder / "scene.json", R"({ "aftershade": 1, "camera": {}, "materials": { "grey": {} },
        "meshes": { "model": { "file": "model.gltf" } }, "objects": [ { "shape": "mesh", "mesh": "model" } ] })");
    Diagnostics diagnostics;
    EXPECT_FALSE(read_scene(folder / "scene.json", diagnostics));
    EXPECT_EQ(diagnostics.error_count(), 1) << faults_of(diagnostics);
}

}  // namespace
}  // namespace aftershade::scene
