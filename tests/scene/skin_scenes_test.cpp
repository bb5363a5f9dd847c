// The three views of skin, as docs/scenes.md states them.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "framework/scene/scene_renderer.h"
#include "tests/scene/scene_text.h"

namespace aftershade::scene {
namespace {

constexpr unsigned kSkin = 1;

struct SkinScene {
    const char* id;
    double red_d_px;        ///< at 480 px and the median depth of what scatters
    double unscattered_db;  ///< luminance of the color, against the truth
};

class SkinScenes : public testing::TestWithParam<SkinScene> {};

/// Variance in mm^2 and weights of red, green and blue: d'Eon, Luebke and Enderton 2007.
constexpr double kSixGaussians[6][4] = {{0.0064, 0.233, 0.455, 0.649}, {0.0484, 0.100, 0.336, 0.344},
                                        {0.187, 0.118, 0.198, 0},      {0.567, 0.113, 0.007, 0.007},
                                        {1.99, 0.358, 0.004, 0},       {7.41, 0.078, 0, 0}};

TEST_P(SkinScenes, HaveTheRmsRadiusOfTheSixGaussians) {
    const Scene scene = shipped_scene(GetParam().id);
    int scattering = 0;
    for (const Material& material : scene.materials) {
        if (!material.scattering) continue;
        ++scattering;
        for (int c = 0; c < 3; ++c) {
            double square_mm2 = 0;
            for (const auto& gaussian : kSixGaussians) square_mm2 += 2 * gaussian[0] * gaussian[c + 1];
            // The mean square radius of Burley's profile is 14 d^2.
            EXPECT_NEAR(1000 * material.scattering->d_m[c], std::sqrt(square_mm2 / 14), 1e-3) << c;
        }
    }
    EXPECT_EQ(scattering, 1);
}

TEST_P(SkinScenes, ShowADOfTheStatedPixels) {
    const Scene scene = shipped_scene(GetParam().id);
    const Capture capture = SceneRenderer(scene, 480, 270, 2).render_capture(1);
    const Image &depth = capture.images.at("depth"), &id = capture.images.at("object_id");
    std::vector<double> depths_m;
    for (int y = 0; y < 270; ++y)
        for (int x = 0; x < 480; ++x)
            if (id.uint_at(x, y, 0) == kSkin) depths_m.push_back(depth.at(x, y, 0));
    ASSERT_GT(depths_m.size(), 40000u);
    const auto middle = depths_m.begin() + std::ptrdiff_t(depths_m.size() / 2);
    std::nth_element(depths_m.begin(), middle, depths_m.end());
    const CameraState camera = state_at(scene, 1, 1).camera;
    const double px_per_m = 480 * camera.focal_length_mm / scene.camera.sensor_width_mm / *middle;
    EXPECT_NEAR(0.4445e-3 * px_per_m, GetParam().red_d_px, 0.02 * GetParam().red_d_px);
}

double luminance(const Image& color, int x, int y) {
    const double y709 = 0.2126 * color.at(x, y, 0) + 0.7152 * color.at(x, y, 1) + 0.0722 * color.at(x, y, 2);
    return std::clamp(y709, 0.0, 1.0);
}

TEST_P(SkinScenes, AreFarFromTheirTruthByTheStatedAndElsewhereAreIt) {
    const Scene scene = shipped_scene(GetParam().id);
    const SceneRenderer renderer(scene, 160, 90, 2);
    const Capture capture = renderer.render_capture(1);
    const ScatteringTruth truth = renderer.render_scattering(1, {.samples = 128});
    const Image &color = capture.images.at("color"), &id = capture.images.at("object_id");
    double sum = 0;
    int count = 0, others = 0;
    for (int y = 0; y < 90; ++y)
        for (int x = 0; x < 160; ++x) {
            if (id.uint_at(x, y, 0) == kSkin) {
                const double off = luminance(color, x, y) - luminance(truth.color, x, y);
                sum += off * off;
                ++count;
                continue;
            }
            ++others;
            for (int c = 0; c < 3; ++c) ASSERT_EQ(color.at(x, y, c), truth.color.at(x, y, c));
        }
    EXPECT_GT(others, 400);
    EXPECT_NEAR(-10 * std::log10(sum / count), GetParam().unscattered_db, 1);
}

INSTANTIATE_TEST_SUITE_P(Shipped, SkinScenes,
                         testing::Values(SkinScene{"skin_patch", 8.2, 29.4},
                                         SkinScene{"skin_ear", 2.55, 34.7},
                                         SkinScene{"skin_front", 0.89, 39.7}),
                         [](const auto& scene) { return std::string(scene.param.id); });

}  // namespace
}  // namespace aftershade::scene
