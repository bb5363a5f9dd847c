// Shading samples that live from frame to frame, against light computed for every frame.
#include "framework/scene/kept_shadings.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "framework/scene/triangulate.h"
#include "framework/scene/visibility.h"
#include "tests/scene/scene_text.h"
#include "tests/scene/with_samples.h"

namespace aftershade::scene {
namespace {

using Pictures = std::vector<VisibilityPicture>;

Pictures pictures_of(const Scene& scene, int frames, const VisibilitySettings& settings, bool keeps,
                     int threads = 2) {
    const Scene triangles = triangulated(scene);
    const SceneRenderer renderer(triangles, scene.width_px, scene.height_px, threads);
    KeptShadings kept;
    Pictures pictures;
    for (int frame = 1; frame <= frames; ++frame)
        pictures.push_back(render_visibility(renderer, frame, settings, {}, keeps ? &kept : nullptr));
    return pictures;
}

bool are_same(const VisibilityPicture& a, const VisibilityPicture& b) {
    return std::ranges::equal(a.color.floats(), b.color.floats());
}

std::uint64_t shadings_of(const Pictures& pictures) {
    return std::accumulate(
        pictures.begin(), pictures.end(), std::uint64_t(0),
        [](std::uint64_t sum, const VisibilityPicture& picture) { return sum + picture.report.shadings; });
}

/// Over all frames.
double psnr_db(const Pictures& a, const Pictures& b) {
    double sum = 0, count = 0;
    for (std::size_t frame = 0; frame < a.size(); ++frame)
        for (std::size_t i = 0; i < a[frame].color.floats().size(); ++i, ++count)
            sum += std::pow(double(a[frame].color.floats()[i]) - double(b[frame].color.floats()[i]), 2);
    return 10 * std::log10(count / sum);
}

/// A shiny floor, a block and a pane on it, lit by a lamp with soft shadows, a sun and the sky. `extra` is an
/// object behind the others in the list, so that their samples have the same random rays in every frame.
Scene still_life(const std::string& camera_keys, const std::string& extra = "",
                 const std::string& sun = "2") {
    return scene_of(fmt::format(R"({{ "aftershade": 1, "size": [96, 54], "ambient": 0.2, "ambient_rays": 4,
        "camera": {{ "position": {}, "target": [0, 0.2, 0], "focus_distance": 3, "f_number": 1 }},
        "shutter": {{ "angle": 180 }},
        "materials": {{
          "floor": {{ "albedo": {{ "checker": [[0.7, 0.6, 0.5], [0.2, 0.25, 0.3]], "cells": [16, 16] }},
                      "specular": 0.04, "roughness": 0.3 }},
          "clay": {{ "albedo": [0.6, 0.3, 0.2], "specular": 0 }},
          "glass": {{ "albedo": [0.1, 0.4, 0.2], "specular": 0.04, "opacity": 0.5 }} }},
        "objects": [
          {{ "shape": "plane", "size": [6, 6], "rotation": [-90, 0, 0], "material": "floor" }},
          {{ "shape": "box", "size": 0.6, "position": [0.5, 0.3, -0.4], "material": "clay" }},
          {{ "shape": "plane", "size": [0.5, 0.5], "position": [-0.5, 0.3, 0.3], "material": "glass" }}{} ],
        "lights": [
          {{ "type": "area", "position": [-1, 2, 1], "target": [0, 0, 0], "size": [0.5, 0.5], "intensity": 3,
             "shadow_samples": 2 }},
          {{ "type": "directional", "position": [2, 3, 1], "intensity": {} }} ] }})",
                                camera_keys, extra.empty() ? "" : ",\n" + extra, sun));
}

constexpr const char* kStill = "[0, 0.8, 3]";
constexpr const char* kWalk = R"({ "keys": { "0": [0, 0.8, 3], "24": [0.4, 0.9, 2.8] } })";

TEST(KeptShadings, OfASceneAtRestGiveTheBitsOfLightComputedForEveryFrame) {
    const Scene scene = still_life(kStill);
    for (const Transparency transparency : {Transparency::stochastic, Transparency::lists}) {
        VisibilitySettings settings = with_samples(8);
        settings.transparency.transparency = transparency;
        const Pictures fresh = pictures_of(scene, 3, settings, false),
                       kept = pictures_of(scene, 3, settings, true);
        for (std::size_t i = 0; i < fresh.size(); ++i) {
            const VisibilityReport &own = kept[i].report, &other = fresh[i].report;
            EXPECT_TRUE(are_same(fresh[i], kept[i])) << i;
            EXPECT_EQ(own.shadings + own.kept, other.shadings);
            if (i > 0) EXPECT_LT(10 * own.shadings, other.shadings);
            const auto rates = kept[i].shading_rate.floats();
            EXPECT_NEAR(std::accumulate(rates.begin(), rates.end(), 0.0), double(own.shadings),
                        1e-4 * double(other.shadings));
        }
    }
}

TEST(KeptShadings, OfTexturesAndNormalMapsAtRestGiveTheBitsOfLightComputedForEveryFrame) {
    Scene urn = shipped_scene("urn");
    urn.width_px = 96;
    urn.height_px = 54;
    const Pictures fresh = pictures_of(urn, 3, with_samples(8), false),
                   kept = pictures_of(urn, 3, with_samples(8), true);
    for (std::size_t i = 0; i < fresh.size(); ++i) EXPECT_TRUE(are_same(fresh[i], kept[i])) << i;
    EXPECT_GT(kept[1].report.kept, 1000u);
    EXPECT_GT(kept[1].report.highlights, 100u);
}

TEST(KeptShadings, GoWhereSomethingMovesAndWhereItsShadowWasOrIs) {
    // The second ball stays outside the picture, which has its shadow alone.
    for (const char* ball : {R"({ "shape": "sphere", "radius": 0.2, "material": "clay",
               "position": { "keys": { "0": [-0.9, 0.2, 0.6], "8": [0.7, 0.2, 0.6] } } })",
                             R"({ "shape": "sphere", "radius": 0.2, "material": "clay",
               "position": { "keys": { "0": [0.6, 2, 1.2], "8": [0.2, 2, 0.4] } } })"}) {
        const Scene scene = still_life(kStill, ball);
        const Pictures fresh = pictures_of(scene, 6, with_samples(8), false),
                       kept = pictures_of(scene, 6, with_samples(8), true);
        for (std::size_t i = 0; i < fresh.size(); ++i) EXPECT_TRUE(are_same(fresh[i], kept[i])) << i;
        EXPECT_FALSE(are_same(fresh[0], fresh[1]));
        EXPECT_LT(double(shadings_of(kept)), 0.8 * double(shadings_of(fresh)));
        EXPECT_GT(kept[1].report.shadings, 200u);
    }
}

TEST(KeptShadings, KeepNothingOfAnObjectThatTurns) {
    const Scene scene = scene_of(R"({ "aftershade": 1, "size": [96, 54], "ambient": 0.5,
        "camera": { "position": [0, 0, 3], "target": [0, 0, 0] },
        "objects": [ { "shape": "box", "size": 1, "rotation": { "keys": { "0": [0, 0, 0], "8": [0, 90, 0] } } } ] })");
    for (const VisibilityPicture& picture : pictures_of(scene, 3, with_samples(8), true)) {
        EXPECT_EQ(picture.report.kept, 0u);
        EXPECT_GT(picture.report.shadings, 100u);
    }
}

TEST(KeptShadings, GoWithALightThatChanges) {
    const Scene scene =
        still_life(kStill, "", R"({ "keys": { "1": 2, "3": 0.5 }, "interpolation": "step" })");
    const Pictures fresh = pictures_of(scene, 4, with_samples(8), false),
                   kept = pictures_of(scene, 4, with_samples(8), true);
    for (std::size_t i = 0; i < fresh.size(); ++i) {
        EXPECT_TRUE(are_same(fresh[i], kept[i])) << i;
        EXPECT_EQ(kept[i].report.kept == 0, i == 0 || i == 2) << i;
    }
}

TEST(KeptShadings, ShowWhatACameraThatMovesWouldSee) {
    const Scene scene = still_life(kWalk);
    const Pictures fresh = pictures_of(scene, 24, with_samples(16), false),
                   kept = pictures_of(scene, 24, with_samples(16), true);
    EXPECT_LT(double(shadings_of(kept)), 0.4 * double(shadings_of(fresh)));
    EXPECT_GT(psnr_db(fresh, kept), 34);
    EXPECT_GT(kept[20].report.highlights, 100u);
    VisibilitySettings plain = with_samples(64);
    plain.visibility = Visibility::supersampled;
    plain.seed = 7;
    const Scene triangles = triangulated(scene);
    const SceneRenderer renderer(triangles, scene.width_px, scene.height_px, 2);
    Pictures truth, fresh_there, kept_there;
    for (const int frame : {6, 12, 18, 24}) {
        truth.push_back(render_visibility(renderer, frame, plain));
        fresh_there.push_back(fresh[std::size_t(frame) - 1]);
        kept_there.push_back(kept[std::size_t(frame) - 1]);
    }
    EXPECT_GT(psnr_db(truth, kept_there), psnr_db(truth, fresh_there) - 0.3);
}

TEST(KeptShadings, NeedFewShadingsWhereACameraWalksThroughAHall) {
    Scene hall = shipped_scene("camera_checker");
    hall.width_px = 96;
    hall.height_px = 54;
    const Pictures fresh = pictures_of(hall, 12, with_samples(8), false),
                   kept = pictures_of(hall, 12, with_samples(8), true);
    EXPECT_LT(double(shadings_of(kept)), 0.45 * double(shadings_of(fresh)));
}

TEST(KeptShadings, AreTheSameOnAnyNumberOfThreads) {
    const Scene scene = still_life(kWalk);
    const Pictures one = pictures_of(scene, 3, with_samples(8), true, 1),
                   many = pictures_of(scene, 3, with_samples(8), true, 5);
    for (std::size_t i = 0; i < one.size(); ++i) EXPECT_TRUE(are_same(one[i], many[i])) << i;
    EXPECT_EQ(shadings_of(one), shadings_of(many));
}

TEST(KeptShadings, LeaveTheirGridsWhereCellsBecomeLongerThanPixels) {
    // A wall of one cell a px that the camera walks up to: cells grow as the distance shrinks.
    const Scene scene = triangulated(scene_of(R"({ "aftershade": 1, "size": [96, 54], "ambient": 0.5,
        "camera": { "position": { "keys": { "0": [0, 0, 10], "10": [0, 0, 5] } }, "target": [0, 0, -1] },
        "objects": [ { "shape": "plane", "size": [8, 8] } ] })"));
    const SceneRenderer renderer(scene, 96, 54, 1);
    KeptShadings kept;
    double made_at_m = 10, finer = 1;
    for (int frame = 0; frame <= 10; ++frame) {
        const double distance_m = 10 - 0.5 * frame;
        if (made_at_m / distance_m > finer * kMostStretch) {
            made_at_m = distance_m;
            finer = kFiner;
        }
        const ShadingGrids grids = kept.next_frame(renderer, frame, {});
        for (const TriangleGrid& grid : grids.grids()) {
            const double camera_m = grids.of_frame().cameras[grid.camera].world_from_camera[3].z;
            EXPECT_NEAR(camera_m, made_at_m, 1e-9) << frame;
        }
    }
}

TEST(Highlights, AreThoseOfTheWholeShadingForAnyEye) {
    const Scene scene = still_life(kStill);
    const SceneRenderer renderer(scene, 96, 54, 1);
    const World world = renderer.world_at(1, 1);
    const CameraState& camera = world.state().camera;
    int lit = 0;
    for (int i = 0; i < 200; ++i) {
        const glm::dvec2 px(13 * i % 96 + 0.5, 7 * i % 54 + 0.5);
        const auto surface = world.trace(renderer.camera_ray(camera, px, glm::dvec2(0)), 0, 1e9);
        if (!surface) continue;
        std::vector<double> seen(2);
        world.shade(*surface, glm::dvec3(camera.world_from_camera[3]), seen);
        for (const glm::dvec3 eye : {glm::dvec3(1, 1, 2), glm::dvec3(-2, 3, 0.5)}) {
            const glm::dvec3 whole = world.shade(*surface, eye).specular;
            EXPECT_EQ(world.highlights(*surface, eye, seen), whole);
            lit += whole != glm::dvec3(0);
        }
    }
    EXPECT_GT(lit, 50);
}

}  // namespace
}  // namespace aftershade::scene
