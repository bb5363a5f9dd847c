// Light at shading samples as a compute shader, against the CPU renderer in double precision.
#include "framework/visibility/gpu_light.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "framework/base/error.h"
#include "framework/scene/triangulate.h"
#include "framework/scene/visibility.h"
#include "tests/gpu/gpu_test.h"
#include "tests/scene/alpha_file.h"
#include "tests/scene/scene_text.h"

namespace aftershade::visibility {
namespace {

class LightOn : public gpu::SoftwareTest {};
ON_EACH_BACKEND(LightOn);

constexpr glm::ivec2 kLitSize_px(160, 90);

struct Pictures {
    Image on_cpu;
    Image on_gpu;
};

/// Of the same ids, which the CPU has traced.
Pictures pictures(gpu::Context& context, const scene::Scene& scene, int frame, int samples,
                  std::size_t max_buffer_bytes = kMaxBufferBytes, const glm::ivec2& size_px = kLitSize_px) {
    Passes passes(context);
    const scene::Scene triangles = scene::triangulated(scene);
    const scene::SceneRenderer renderer(triangles, size_px.x, size_px.y, 2);
    const scene::ShadingGrids grids(renderer, frame, {});
    scene::VisibilitySettings settings;
    settings.samples = samples;
    const std::vector<std::uint32_t> ids = scene::trace_ids(renderer, grids, frame, settings);
    const scene::CacheReplay kept = scene::replay({ids, size_px.x, size_px.y, samples}, {});
    const scene::SampleIds addresses{kept.addresses, size_px.x, size_px.y, samples};
    return {scene::resolve_light(renderer, grids, kept.ids, addresses),
            resolve_light(passes, renderer, grids, kept.ids, addresses, max_buffer_bytes)};
}

/// The share of pixels in which a channel differs by more than a thousandth of its value and of 0.1.
double other_pixels(const Pictures& both) {
    int other = 0;
    const int width = both.on_cpu.width(), height = both.on_cpu.height();
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            bool differs = false;
            for (int c = 0; c < 3; ++c) {
                const float a = both.on_cpu.at(x, y, c), b = both.on_gpu.at(x, y, c);
                differs = differs || !(std::abs(a - b) <= 1e-3f * (std::abs(a) + 0.1f));
            }
            other += differs ? 1 : 0;
        }
    return other / double(width * height);
}

TEST_P(LightOn, LightsShippedScenesAsTheCpuDoesButAtEdgesOfShadowsAndChecks) {
    for (const auto& [id, frame] :
         {std::pair("bats", 6), {"toys", 4}, {"camera_checker", 6}, {"panes", 4}, {"smoke", 4}}) {
        const Pictures both = pictures(context(), scene::shipped_scene(id), frame, 1);
        EXPECT_LT(other_pixels(both), 0.001) << id;
    }
}

TEST_P(LightOn, LightsTexturesAndNormalMapsAsTheCpuDoes) {
    // The highlights of the urn's gold are narrow, and the last digits of the normal map move them.
    const Pictures both = pictures(context(), scene::shipped_scene("urn"), 4, 1);
    EXPECT_LT(other_pixels(both), 0.004);
}

TEST_P(LightOn, WrapsTexturesAndScalesMapsAsTheCpuDoes) {
    using namespace scene::test;
    const auto texel = [](int x, int y) { return glm::ivec3(90 + 60 * x, 80 + 50 * y, 200); };
    const std::string material =
        R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0.5},
        "normalTexture": {"index": 0, "scale": 0.5}, "occlusionTexture": {"index": 0, "strength": 0.5})";
    const std::string light =
        R"("ambient": 0.3, "lights": [{ "type": "directional", "position": [1, 2, 3] }],)";
    for (const char* sampler :
         {R"("wrapS": 33648, "wrapT": 33071)", R"("wrapS": 33071, "wrapT": 33648, "magFilter": 9728)"}) {
        const TemporaryFolder folder;
        write_text(folder / "model.gltf",
                   textured_quad(material, {.sampler = sampler,
                                            .uv_low = {-1, -1},
                                            .uv_high = {2, 2},
                                            .tangents = {0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1},
                                            .pictures = {png_of(3, 3, texel)}})
                       .text());
        const scene::Scene quad = quad_scene(folder.path(), 64, light);
        EXPECT_LT(other_pixels(pictures(context(), quad, 1, 1, kMaxBufferBytes, {64, 64})), 0.01) << sampler;
    }
}

TEST_P(LightOn, ShinesThroughAlphaAndByFurtherTextureCoordinatesAsTheCpus) {
    for (const std::string& mode : {scene::test::kBlend, scene::test::kMask}) {
        const scene::test::TemporaryFolder folder;
        const scene::Scene scene = scene::test::alpha_scene(folder.path(), mode);
        EXPECT_LT(other_pixels(pictures(context(), scene, 1, 1)), 0.005) << mode;
    }
}

TEST_P(LightOn, WeighsTheColoursOfAlphaAsTheCpuDoes) {
    using namespace scene::test;
    const std::string png = rgba_png(64, 64, [](int x, int y) {
        return (x + y) % 2 == 0 ? glm::ivec4(200, 60, 30, 255) : glm::ivec4(0, 255, 0, 4 * x);
    });
    const std::string all = R"(, "alphaMode": "MASK", "alphaCutoff": 0)";
    for (const std::string& mode : {std::string(kBlend), std::string(kMask), all})
        for (const int side_px : {11, 100}) {
            const TemporaryFolder folder;
            write_text(folder / "model.gltf", textured_quad(kPainted + mode, {.pictures = {png}}).text());
            const scene::Scene quad = quad_scene(folder.path(), side_px, R"("ambient": 0.5,)");
            const Pictures both = pictures(context(), quad, 1, 1, kMaxBufferBytes, {side_px, side_px});
            EXPECT_LT(other_pixels(both), 0.01) << mode << side_px;
        }
}

TEST_P(LightOn, RefusesTexturesThatNoBufferHolds) {
    try {
        pictures(context(), scene::shipped_scene("urn"), 4, 1, 4096);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        const std::string text = error.what();
        EXPECT_NE(text.find("urn/scene.json: textures of "), std::string::npos) << text;
        EXPECT_NE(text.find("the limit of visibility by GL is 4096; scale them down"), std::string::npos)
            << text;
    }
}

TEST_P(LightOn, RefusesObjectsWhoseSizeSinglePrecisionDoesNotHold) {
    const scene::Scene scene =
        scene::scene_of(R"({ "aftershade": 1, "camera": {}, "materials": { "grey": {} },
        "objects": [ { "name": "sky", "shape": "sphere", "radius": 1e6, "scale": 1e5, "material": "grey" } ] })");
    try {
        pictures(context(), scene, 1, 1, kMaxBufferBytes, {4, 4});
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        const std::string text = error.what();
        EXPECT_NE(text.find("object 'sky' reaches 100000"), std::string::npos) << text;
        EXPECT_NE(text.find("m, the limit of visibility by GL is 1000000000; choose visibility_on cpu"),
                  std::string::npos)
            << text;
    }
}

/// A floor, a stretched box, a ball and a pane, under one light.
scene::Scene room_under(const std::string& light) {
    return scene::scene_of(R"({ "aftershade": 1, "frames": "1", "size": [160, 90],
  "camera": { "position": [0.4, 1.4, 4], "target": [0, 0.2, 0], "focal_length": "40 mm", "focus_distance": "4 m", "f_number": 1 },
  "background": [0.1, 0.2, 0.3], "ambient": 0.05,
  "materials": {
    "floor": { "albedo": { "checker": [[0.8, 0.7, 0.6], [0.3, 0.2, 0.1]], "cells": [7, 5] }, "specular": 0.3, "roughness": 0.4 },
    "ball": { "albedo": [0.6, 0.2, 0.2], "specular": 0.05, "roughness": 0.2, "emission": [0, 0.02, 0.1] },
    "pane": { "albedo": [0.2, 0.5, 0.3], "opacity": 0.4 } },
  "objects": [
    { "name": "floor", "id": 1, "shape": "plane", "size": [8, 6], "rotation": [-90, 0, 0], "material": "floor" },
    { "name": "box", "id": 2, "shape": "box", "size": [0.6, 0.8, 0.5], "position": [-0.9, 0.4, 0.2], "rotation": [0, 30, 0], "scale": [1, 1.2, 0.7], "material": "floor" },
    { "name": "ball", "id": 3, "shape": "sphere", "radius": 0.45, "position": [0.8, 0.45, 0.1], "scale": [1, 0.8, 1], "material": "ball" },
    { "name": "pane", "id": 4, "shape": "plane", "size": [1, 1.2], "position": [0, 0.65, 0.9], "rotation": [0, 20, 0], "material": "pane" } ],
  "lights": [ )" + light + " ] }");
}

TEST_P(LightOn, EveryKindOfLightIsTheCpus) {
    for (
        const std::string light :
        {R"({ "name": "lamp", "type": "point", "position": [1, 2.5, 1.5], "intensity": 9 })",
         R"({ "name": "lamp", "type": "point", "position": [1, 2.5, 1.5], "intensity": 9, "shadows": false })",
         R"({ "name": "sun", "type": "directional", "position": [2, 3, 2], "intensity": 3 })",
         R"({ "name": "sun", "type": "directional", "position": [2, 3, 2], "intensity": 3,
               "pattern": { "type": "edge", "axis": [1, 0, 0], "offset": "110 mm" } })",
         R"({ "name": "sun", "type": "directional", "position": [2, 3, 2], "intensity": 3,
               "pattern": { "type": "cosine", "axis": [1, 0, 0], "period": "900 mm", "amplitude": 0.8 } })",
         R"({ "name": "window", "type": "area", "position": [-1.5, 1.2, 1.5], "target": [0, 0.2, 0], "size": [1.6, 1.2],
               "intensity": 4, "shadow_samples": 4 })",
         R"({ "name": "low window", "type": "area", "position": [-2.4, 0.1, 0.5], "target": [0, 0.3, 0], "size": [1.6, 1.2],
               "intensity": 4, "shadow_samples": 3 })"}) {
        const Pictures both = pictures(context(), room_under(light), 1, 1);
        EXPECT_LT(other_pixels(both), 0.001) << light;
        const auto largest = std::ranges::max_element(both.on_gpu.floats());
        EXPECT_GT(*largest, 0.2f) << light;
    }
}

TEST_P(LightOn, FindsWhatHidesTheAmbientLightByTheRaysOfTheCpu) {
    scene::Scene scene = room_under("");
    scene.ambient = glm::dvec3(0.8);
    scene.ambient_rays = 16;
    const Pictures both = pictures(context(), scene, 1, 1);
    EXPECT_LT(other_pixels(both), 0.005);
    scene.ambient_rays = 0;
    EXPECT_GT(other_pixels({both.on_cpu, pictures(context(), scene, 1, 1).on_gpu}), 0.1);
}

TEST_P(LightOn, IsTheMeanOverTheSamplesOfAPixel) {
    const Pictures both = pictures(context(), scene::shipped_scene("toys"), 4, 27);
    double error = 0;
    for (std::size_t i = 0; i < both.on_cpu.floats().size(); ++i) {
        const double difference = double(both.on_cpu.floats()[i]) - double(both.on_gpu.floats()[i]);
        error += difference * difference;
    }
    const double psnr_db = -10 * std::log10(error / double(both.on_cpu.floats().size()));
    EXPECT_GT(psnr_db, 55);
}

TEST_P(LightOn, IsTheSameInSlicesAndBands) {
    // Of 14,400 pixels and some 13,000 shading samples: 16 KiB hold 1024 of these and six rows.
    const Pictures whole = pictures(context(), scene::shipped_scene("toys"), 4, 4);
    const Pictures in_parts = pictures(context(), scene::shipped_scene("toys"), 4, 4, 16 * 1024);
    for (std::size_t i = 0; i < whole.on_gpu.floats().size(); ++i)
        ASSERT_NEAR(whole.on_gpu.floats()[i], in_parts.on_gpu.floats()[i],
                    2e-6f * (1 + whole.on_gpu.floats()[i]))
            << i;
}

TEST_P(LightOn, IsWholeOrSaysThatGlEndsItsLoopsEarly) {
    std::string lights;
    for (int i = 0; i < 8; ++i)
        lights +=
            std::string(i > 0 ? "," : "") + R"({ "name": "window )" + std::to_string(i) +
            R"(", "type": "area", "position": [-1.5, 1.2, 1.5], "target": [0, 0.2, 0], "size": [1.6, 1.2],
                     "intensity": 1, "shadow_samples": 16 })";
    try {
        // 2048 shadow rays for each shading sample.
        const Pictures both = pictures(context(), room_under(lights), 1, 1, kMaxBufferBytes, {32, 18});
        EXPECT_LT(other_pixels(both), 0.001);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::effect);
        EXPECT_NE(std::string(error.what()).find("choose visibility_on cpu"), std::string::npos)
            << error.what();
    }
}

TEST_P(LightOn, IsTheBackgroundWhereNothingIsMet) {
    const scene::Scene scene = scene::scene_of(R"({ "aftershade": 1, "frames": "1", "size": [160, 90],
        "camera": { "position": [0, 0, 4], "target": [0, 0, 0] }, "background": [0.5, 0.25, 2],
        "materials": { "grey": { "albedo": 0.5 } },
        "objects": [ { "name": "behind", "id": 1, "shape": "sphere", "radius": 0.5, "position": [0, 0, 9], "material": "grey" } ],
        "lights": [] })");
    const Pictures both = pictures(context(), scene, 1, 3);
    const glm::vec4 expected(0.5f, 0.25f, 2, 1);
    for (int c = 0; c < 4; ++c) EXPECT_FLOAT_EQ(both.on_gpu.at(80, 45, c), expected[c]);
}

}  // namespace
}  // namespace aftershade::visibility
