// True pictures against closed forms.
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "framework/scene/scene_renderer.h"
#include "tests/polygon.h"
#include "tests/scene/scene_text.h"

namespace aftershade::scene {
namespace {

Image red_of(const Image& image) {
    Image red(image.width(), image.height(), 1);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) red.at(x, y, 0) = image.at(x, y, 0);
    return red;
}

struct Lens {
    int blades;
    double depth_m;
    double rotation_deg;
};

class LensTruth : public testing::TestWithParam<Lens> {};

constexpr int kSide_px = 121;
constexpr int kMiddle = 60;

/// A small bright disk in the middle of the picture, 5 px across, focus at 4 m.
Scene bright_point(const Lens& lens) {
    const double px_per_tangent = kSide_px * 100.0 / 36;
    return scene_of(fmt::format(R"({{ "aftershade": 1, "size": [121, 121],
        "camera": {{ "position": [0, 0, 0], "target": [0, 0, -1], "focal_length": 100, "focus_distance": 4,
                     "f_number": 0.12, "blades": {}, "rotation": {} }},
        "materials": {{ "lamp": {{ "albedo": 0, "specular": 0, "emission": 100 }} }},
        "objects": [ {{ "shape": "disk", "radius": {}, "position": [0, 0, {}], "material": "lamp" }} ] }})",
                                lens.blades, lens.rotation_deg, 2.5 * lens.depth_m / px_per_tangent,
                                -lens.depth_m));
}

TEST_P(LensTruth, ShowsThePolygonOfTheApertureInTheSizeOfThePinholeModel) {
    const Lens lens = GetParam();
    const Scene scene = bright_point(lens);
    TruthSettings settings;
    settings.kinds.lens = true;
    settings.samples = 2048;
    const Image picture = red_of(SceneRenderer(scene, kSide_px, kSide_px, 2).render_truth(1, settings));
    // DESIGN's pinhole model, in mm on the sensor: diameter A f / S1 * |S2 - S1| / S2.
    const double aperture_mm = 100 / 0.12;
    const double diameter_mm = aperture_mm * 100 / 4000 * std::abs(lens.depth_m - 4) / lens.depth_m;
    const double radius_px = diameter_mm / 2 * kSide_px / 36;
    const double turned_deg = lens.rotation_deg + (lens.depth_m < 4 ? 180 : 0);
    const Image expected =
        aftershade::test::coverage(aftershade::test::regular_polygon(lens.blades, radius_px, turned_deg),
                                   kSide_px, kSide_px, kMiddle, kMiddle);
    // The light of the whole picture over the polygon's area; and its second moment, that of a regular
    // polygon, R^2 (2 + cos(2 pi / n)) / 6, and that of the disk, r^2 / 2, together.
    double energy = 0, moment = 0;
    for (int y = 0; y < kSide_px; ++y)
        for (int x = 0; x < kSide_px; ++x) {
            energy += picture.at(x, y, 0);
            moment += picture.at(x, y, 0) * (std::pow(x - kMiddle, 2) + std::pow(y - kMiddle, 2));
        }
    const double angle_rad = 2 * std::numbers::pi / lens.blades;
    const double plateau = energy / (lens.blades / 2.0 * std::sin(angle_rad) * radius_px * radius_px);
    const double measured_px = std::sqrt(6 * (moment / energy - 2.5 * 2.5 / 2) / (2 + std::cos(angle_rad)));
    const double iou = aftershade::test::shape_iou(picture, plateau, expected);
    EXPECT_GE(iou, 0.97);
    EXPECT_NEAR(2 * measured_px, 2 * radius_px, 0.5);
    RecordProperty("iou", fmt::format("{:.4f}", iou));
    RecordProperty("diameter_px", fmt::format("{:.2f} of {:.2f}", 2 * measured_px, 2 * radius_px));
}

INSTANTIATE_TEST_SUITE_P(BladesNearAndFar, LensTruth,
                         testing::Values(Lens{3, 2, 0}, Lens{3, 80, 0}, Lens{5, 2, 0}, Lens{5, 80, 20},
                                         Lens{6, 2, 10}, Lens{6, 80, 0}, Lens{7, 2, -15}, Lens{7, 80, 0}));

TEST(LensTruth, LeavesThePlaneOfFocusAsItIs) {
    const Scene scene = scene_of(R"({ "aftershade": 1, "size": [96, 54],
        "camera": { "position": [0, 0, 5], "focus_distance": 5, "f_number": 0.1 },
        "materials": { "tiles": { "albedo": { "checker": [0.1, 0.9], "cells": [24, 12] }, "specular": 0 } },
        "objects": [ { "shape": "plane", "size": [8, 4], "material": "tiles" } ],
        "ambient": 1 })");
    const SceneRenderer renderer(scene, 96, 54, 2);
    const Image sharp = renderer.render_capture(1).images.at("color");
    TruthSettings settings;
    settings.kinds.lens = true;
    settings.samples = 64;
    const Image truth = renderer.render_truth(1, settings);
    for (std::size_t i = 0; i < sharp.floats().size(); ++i)
        ASSERT_NEAR(sharp.floats()[i], truth.floats()[i], 1e-6);
}

const char* const kMovingLamp = R"({{ "aftershade": 1, "size": [200, 8],
    "camera": {{ "position": [0, 0, 10], "focal_length": 18, "sensor_width": 36 }},
    "shutter": {{ "angle": {}, "phase": "{}" }},
    "materials": {{ "lamp": {{ "albedo": 0, "specular": 0, "emission": 1 }} }},
    "objects": [ {{ "shape": "plane", "size": [4, 20], "material": "lamp",
                   "position": {{ "keys": {{ "0": [-4, 0, 0], "10": [4, 0, 0] }} }} }} ] }})";

/// Part of [open, close] in which |pixel - middle(t)| is below half the width; 100 px per unit of tangent, 10
/// m away.
double exposed(double pixel, double open, double close) {
    const auto middle_px = [](double time) { return 100 + (-4 + 0.8 * time) * 10; };
    const double from = (pixel - 20 - middle_px(0)) / 8, to = (pixel + 20 - middle_px(0)) / 8;
    return std::max(0.0, std::min(close, to) - std::max(open, from)) / (close - open);
}

struct Shutter {
    double angle_deg;
    const char* phase;
    double open, close;
};

class ShutterTruth : public testing::TestWithParam<Shutter> {};

TEST_P(ShutterTruth, MakesATranslatingBoxATrapezoidOfTheExactLength) {
    const Shutter shutter = GetParam();
    const Scene scene = scene_of(fmt::format(fmt::runtime(kMovingLamp), shutter.angle_deg, shutter.phase));
    TruthSettings settings;
    settings.kinds.shutter = true;
    settings.samples = 512;
    for (const TruthMethod method : {TruthMethod::accumulation, TruthMethod::interleaved}) {
        settings.method = method;
        const Image truth = SceneRenderer(scene, 200, 8, 2).render_truth(5, settings);
        for (int x = 0; x < 200; ++x)
            ASSERT_NEAR(truth.at(x, 3, 0), exposed(x + 0.5, shutter.open, shutter.close), 1.5 / 512) << x;
    }
}

INSTANTIATE_TEST_SUITE_P(Phases, ShutterTruth,
                         testing::Values(Shutter{180, "center", 4.75, 5.25}, Shutter{360, "center", 4.5, 5.5},
                                         Shutter{180, "start", 5, 5.5}, Shutter{90, "end", 4.75, 5}));

TEST(Truth, OfThePixelsAreaIsItsCoverage) {
    // A square turned by 12 degrees with a circumradius of 30 px, about the middle of pixel (60, 60).
    const Scene scene = scene_of(R"({ "aftershade": 1, "size": [121, 121],
        "camera": { "position": [0, 0, 10], "focal_length": 36, "sensor_width": 36 },
        "materials": { "lamp": { "albedo": 0, "specular": 0, "emission": 1 } },
        "objects": [ { "shape": "plane", "size": [3.50626, 3.50626], "rotation": [0, 0, -12], "material": "lamp" } ] })");
    TruthSettings settings;
    settings.kinds.antialias = true;
    settings.samples = 2048;
    const double circumradius_px = 3.50626 / std::sqrt(2) * 12.1;
    const Image expected = aftershade::test::coverage(
        aftershade::test::regular_polygon(4, circumradius_px, 12), 121, 121, 60, 60);
    for (const TruthMethod method : {TruthMethod::accumulation, TruthMethod::interleaved}) {
        settings.method = method;
        const Image truth = SceneRenderer(scene, 121, 121, 2).render_truth(1, settings);
        double worst = 0;
        for (int y = 0; y < 121; ++y)
            for (int x = 0; x < 121; ++x)
                worst = std::max(worst, std::abs(double(truth.at(x, y, 0) - expected.at(x, y, 0))));
        EXPECT_LT(worst, 0.02);
    }
}

TEST(Truth, InterleavedHasNoiseWhereAccumulationHasGhosts) {
    const Scene scene = scene_of(fmt::format(fmt::runtime(kMovingLamp), 360, "center"));
    TruthSettings settings;
    settings.kinds.shutter = true;
    settings.samples = 2;
    const SceneRenderer renderer(scene, 200, 8, 2);
    const Image ghosts = renderer.render_truth(5, settings);
    settings.method = TruthMethod::interleaved;
    const Image noise = renderer.render_truth(5, settings);
    int rows_differ = 0;
    for (int x = 0; x < 200; ++x) {
        for (int y = 1; y < 8; ++y) {
            ASSERT_EQ(ghosts.at(x, y, 0), ghosts.at(x, 0, 0));
            rows_differ += noise.at(x, y, 0) != noise.at(x, 0, 0);
        }
    }
    EXPECT_GT(rows_differ, 5);
}

TEST(Truth, OfSubframesAveragedIsTheShuttersOwn) {
    const Scene scene = shipped_scene("wheel");
    const SceneRenderer renderer(scene, 96, 54, 2);
    TruthSettings settings;
    settings.kinds.shutter = true;
    settings.samples = 16;
    const Image truth = renderer.render_truth(4, settings);
    std::vector<double> sum(truth.floats().size());
    for (int s = 0; s < 16; ++s) {
        const Image part =
            renderer.render_capture(4, exposure_of(scene.camera, 4).middle(s, 16)).images.at("color");
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += double(part.floats()[i]) / 16;
    }
    for (std::size_t i = 0; i < sum.size(); ++i) ASSERT_NEAR(truth.floats()[i], sum[i], 1e-5);
}

}  // namespace
}  // namespace aftershade::scene
