// Surfaces that let light through: captures, shadows and truths against closed forms, stochastic transparency
// and lists against sorted blending.
#include "framework/scene/transparency.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "framework/scene/triangulate.h"
#include "framework/scene/visibility.h"
#include "tests/scene/scene_text.h"

namespace aftershade::scene {
namespace {

/// A pane of light 3 that stops half, before one of light 5 that stops a quarter, before a background of 7.
Scene two_panes() {
    return scene_of(R"({ "aftershade": 1, "size": [16, 16], "background": 7,
        "camera": { "position": [0, 0, 4], "target": [0, 0, 0], "focus_distance": 3, "f_number": 0.5 },
        "materials": { "near": { "albedo": 0, "specular": 0, "emission": 3, "opacity": 0.5 },
                       "far": { "albedo": 0, "specular": 0, "emission": 5, "opacity": 0.25 } },
        "objects": [ { "id": 1, "shape": "plane", "size": [40, 40], "position": [0, 0, -2], "material": "far" },
                     { "id": 2, "shape": "plane", "size": [40, 40], "material": "near" } ] })");
}

constexpr double kTwoPanes = 0.5 * 3 + 0.5 * (0.25 * 5 + 0.75 * 7);

TruthSettings truth_with(int samples) {
    TruthSettings truth;
    truth.kinds = {true, true, true};
    truth.method = TruthMethod::interleaved;
    truth.samples = samples;
    return truth;
}

TEST(TransparentScene, AddsTheLightOfEachSurfaceByItsOpacity) {
    const Scene scene = two_panes();
    const SceneRenderer renderer(scene, 16, 16, 2);
    EXPECT_NEAR(renderer.render_truth(1, truth_with(4)).at(3, 5, 0), kTwoPanes, 1e-5);
    const Capture capture = renderer.render_capture(1);
    EXPECT_NEAR(capture.images.at("color").at(8, 8, 0), kTwoPanes, 1e-5);
    EXPECT_EQ(capture.images.at("color").at(8, 8, 3), 1);
    EXPECT_EQ(capture.images.at("object_id").uint_at(8, 8, 0), 2u);
    EXPECT_FLOAT_EQ(capture.images.at("depth").at(8, 8, 0), 4);
}

TEST(TransparentScene, CrossesABallTwice) {
    const Scene scene = scene_of(R"({ "aftershade": 1, "size": [16, 16], "background": 2,
        "camera": { "position": [0, 0, 4], "target": [0, 0, 0] },
        "materials": { "glow": { "albedo": 0, "specular": 0, "emission": 1, "opacity": 0.4 } },
        "objects": [ { "shape": "sphere", "radius": 3, "material": "glow", "position": [0, 0, -2] } ] })");
    const Capture capture = SceneRenderer(scene, 16, 16, 1).render_capture(1);
    EXPECT_NEAR(capture.images.at("color").at(8, 8, 0), 0.4 + 0.6 * 0.4 + 0.36 * 2, 1e-5);
}

TEST(TransparentScene, ThinsShadowsByEachCrossing) {
    const auto lit = [](const std::string& shape) {
        const Scene scene = scene_of(fmt::format(R"({{ "aftershade": 1, "size": [16, 16],
            "camera": {{ "position": [0, 0, 4], "target": [0, 0, 0] }},
            "materials": {{ "white": {{ "albedo": 1, "specular": 0 }}, "pane": {{ "albedo": 0, "opacity": 0.3 }} }},
            "objects": [ {{ "shape": "plane", "size": [9, 9], "material": "white" }}, {} ],
            "lights": [ {{ "type": "directional", "position": [9, 0, 9] }} ] }})",
                                                 shape));
        return SceneRenderer(scene, 16, 16, 1).render_capture(1).images.at("irradiance").at(8, 8, 0);
    };
    // Beside the camera's rays, across the light's.
    const char* const kPlace = R"("position": [6, 0, 6], "material": "pane" })";
    const float plain =
        lit(fmt::format(R"({{ "shape": "sphere", "radius": 1, "casts_shadow": false, {})", kPlace));
    EXPECT_GT(plain, 0);
    EXPECT_NEAR(lit(fmt::format(R"({{ "shape": "disk", "radius": 1, {})", kPlace)), 0.7f * plain, 1e-6);
    EXPECT_NEAR(lit(fmt::format(R"({{ "shape": "sphere", "radius": 1, {})", kPlace)), 0.49f * plain, 1e-6);
}

TEST(TransparentScene, HasLayersThatFlattenToItsPicture) {
    const Scene scene = shipped_scene("panes");
    const SceneRenderer renderer(scene, 96, 54, 2);
    const Capture flat = renderer.render_capture(4);
    for (const int count : {2, 5}) {
        const std::vector<Capture> layers = renderer.render_layers(4, 4, {0, 0}, count);
        double worst = 0;
        for (int y = 0; y < 54; ++y)
            for (int x = 0; x < 96; ++x) {
                double color = 0, through = 1;
                for (const Capture& layer : layers) {
                    const Image& image = layer.images.at("color");
                    color += through * double(image.at(x, y, 1));
                    through *= 1 - double(image.at(x, y, 3));
                }
                worst = std::max(worst, std::abs(color - double(flat.images.at("color").at(x, y, 1))));
            }
        EXPECT_LT(worst, 1e-5) << count;
    }
}

TEST(TransparentScene, HasDeepSamplesOfItsOpacity) {
    const Scene scene = two_panes();
    const DeepImage deep = SceneRenderer(scene, 16, 16, 1).render_deep(1, 1, {0, 0});
    const auto channel = [&](const std::string& name) {
        return std::find_if(deep.channels.begin(), deep.channels.end(),
                            [&](const DeepImage::Channel& one) { return one.name == name; })
            ->floats;
    };
    const std::vector<float> alpha = channel("A"), red = channel("R");
    ASSERT_EQ(deep.first[1], 3u);
    const std::vector<float> expected_alpha = {0.5f, 0.25f, 1}, expected_red = {1.5f, 1.25f, 7};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(alpha[i], expected_alpha[i], 1e-6);
        EXPECT_NEAR(red[i], expected_red[i], 1e-5);
    }
}

TEST(TransparentScene, EndsWhereARayCrossesMoreThanItCanCount) {
    const Scene scene = scene_of(R"({ "aftershade": 1, "size": [4, 4], "background": 1,
        "camera": { "position": [0, 0, 4], "target": [0, 0, 0] },
        "materials": { "hardly": { "albedo": 0, "specular": 0, "opacity": 0.0001 } },
        "objects": [ { "shape": "plane", "size": [90, 90], "material": "hardly", "position": [0, 0, -20],
                       "repeat": { "count": [1, 1, 1500], "step": [0, 0, 0.01] } } ] })");
    const float light = SceneRenderer(scene, 4, 4, 1).render_truth(1, truth_with(1)).at(2, 2, 0);
    EXPECT_NEAR(light, std::pow(1 - 0.0001, World::kMostCrossings), 1e-5);
}

VisibilitySettings settings_of(int samples, Transparency transparency, std::uint32_t seed = 0) {
    VisibilitySettings settings;
    settings.samples = samples;
    settings.seed = seed;
    settings.transparency.transparency = transparency;
    settings.transparency.list_nodes = kMaxListNodes;
    return settings;
}

/// A scene over triangles, with what renders it.
class Triangles {
public:
    explicit Triangles(const Scene& scene, int width_px, int height_px, int threads = 2)
        : scene_(triangulated(scene)), renderer_(scene_, width_px, height_px, threads) {}
    const SceneRenderer& renderer() const { return renderer_; }
    VisibilityPicture picture(int frame, const VisibilitySettings& settings) const {
        return render_visibility(renderer_, frame, settings);
    }

private:
    Scene scene_;
    SceneRenderer renderer_;
};

double rms(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.floats().size(); ++i)
        sum += std::pow(double(a.floats()[i]) - double(b.floats()[i]), 2);
    return std::sqrt(sum / double(a.floats().size()) * 4 / 3);  // alpha is 1 in both
}

double largest_difference(const Image& a, const Image& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.floats().size(); ++i)
        largest = std::max(largest, std::abs(double(a.floats()[i]) - double(b.floats()[i])));
    return largest;
}

bool is_same(const Image& a, const Image& b) {
    return std::equal(a.floats().begin(), a.floats().end(), b.floats().begin(), b.floats().end());
}

TEST(StochasticTransparency, HasTheSortedPictureAsItsMeanForAnyNumberOfSamples) {
    const Triangles panes(two_panes(), 16, 16);
    for (const int samples : {1, 3, 27, 64}) {
        double sum = 0, squares = 0;
        const int kPictures = 24;
        for (int seed = 0; seed < kPictures; ++seed) {
            const Image color =
                panes.picture(1, settings_of(samples, Transparency::stochastic, std::uint32_t(seed))).color;
            for (int y = 0; y < 16; ++y)
                for (int x = 0; x < 16; ++x) {
                    const double error = double(color.at(x, y, 0)) - kTwoPanes;
                    sum += error;
                    squares += error * error;
                }
        }
        const double count = 16 * 16 * kPictures;
        EXPECT_LT(std::abs(sum / count), 4 * std::sqrt(squares) / count + 1e-6) << samples;
    }
}

/// 35 dB and an error of one over the root of the samples, or less. Pixels are five times as large as the
/// scene's, so that a cell of one px would blur the light more than the samples do: four cells a px.
void expect_nearer_with_samples(const std::string& id) {
    const Triangles scene(shipped_scene(id), 96, 54);
    const Image truth = scene.renderer().render_truth(4, truth_with(128));
    std::map<int, double> error;
    for (const int samples : {4, 16, 64}) {
        VisibilitySettings settings = settings_of(samples, Transparency::stochastic);
        settings.grid.rate = 4;
        error[samples] = rms(truth, scene.picture(4, settings).color);
    }
    EXPECT_LT(error[16], 1.1 * error[4] / 2) << id;
    EXPECT_LT(error[64], 1.1 * error[16] / 2) << id;
    EXPECT_GT(-20 * std::log10(error[64]), 35) << id << ": " << error[64];
}

TEST(StochasticTransparency, IsWithin35DecibelsOfPanesAt64Samples) {
    expect_nearer_with_samples("panes");
}

TEST(StochasticTransparency, IsWithin35DecibelsOfSmokeAt64Samples) {
    expect_nearer_with_samples("smoke");
}

TEST(TransparentLists, EqualTheSortedTruthOfTheSameSamplesWhereSurfacesAreOfOneColour) {
    Scene scene = shipped_scene("panes");
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        Material& material = scene.materials[i];
        material.albedo = material.albedo_2 = glm::dvec3(0);
        material.specular = 0;
        material.emission = glm::dvec3(0.2 + 0.1 * double(i), 0.5, 0.9 - 0.1 * double(i));
    }
    const Triangles panes(scene, 128, 72);
    const VisibilityPicture lists = panes.picture(4, settings_of(64, Transparency::lists));
    EXPECT_EQ(lists.report.list_overflows, 0u);
    EXPECT_LT(largest_difference(lists.color, panes.renderer().render_truth(4, truth_with(64))), 1e-4);
}

/// What lists should give: each sample's shading samples, blended as the ray goes.
Image blended_by_hand(const SceneRenderer& renderer, int frame, const VisibilitySettings& settings) {
    const ShadingGrids grids(renderer, frame, settings.grid);
    std::vector<glm::dvec3> sums(std::size_t(renderer.width_px()) * std::size_t(renderer.height_px()));
    std::map<std::uint32_t, glm::dvec3> light;
    renderer.for_each_sample(
        frame, truth_of(settings), [&](int x, int y, int, const World& world, const Ray& ray) {
            glm::dvec3& sum = sums[std::size_t(y) * std::size_t(renderer.width_px()) + std::size_t(x)];
            double through = 1, low = 0;
            while (const auto surface = world.trace(ray, low, 1e300)) {
                const double opacity = renderer.scene().material_of(surface->object).opacity;
                const auto [place, is_new] = light.try_emplace(grids.id_of(*surface));
                if (is_new) place->second = grids.shade(place->first);
                sum += through * opacity * place->second;
                through *= 1 - opacity;
                low = surface->t * (1 + 1e-7);
                if (opacity == 1) break;
            }
            sum += through * renderer.scene().background;
        });
    Image color(renderer.width_px(), renderer.height_px(), 4);
    for (std::size_t i = 0; i < sums.size(); ++i)
        for (std::size_t c = 0; c < 4; ++c)
            color.floats()[4 * i + c] = c < 3 ? float(sums[i][int(c)] / settings.samples) : 1;
    return color;
}

TEST(TransparentLists, EqualTheirSamplesBlendedInOrder) {
    const Triangles smoke(shipped_scene("smoke"), 96, 54, 1);
    const VisibilitySettings settings = settings_of(16, Transparency::lists);
    const VisibilityPicture lists = smoke.picture(4, settings);
    EXPECT_EQ(lists.report.list_overflows, 0u);
    EXPECT_LT(largest_difference(lists.color, blended_by_hand(smoke.renderer(), 4, settings)), 1e-4);
}

TEST(TransparentLists, CountWhatFindsNoRoomAndStopSamplesByChanceThere) {
    const Triangles smoke(shipped_scene("smoke"), 96, 54);
    VisibilitySettings settings = settings_of(16, Transparency::lists);
    const VisibilityPicture all = smoke.picture(4, settings);
    const Image by_chance = smoke.picture(4, settings_of(16, Transparency::stochastic)).color;
    settings.transparency.list_nodes = 12;
    const VisibilityPicture some = smoke.picture(4, settings);
    EXPECT_EQ(all.report.list_overflows, 0u);
    EXPECT_GT(some.report.list_overflows, 0u);
    EXPECT_LE(some.report.list_nodes, 12u * 96 * 54);
    EXPECT_EQ(some.report.bytes.lists, some.report.list_nodes * sizeof(ListNode) + 96 * 54 * 4);
    EXPECT_LT(rms(all.color, some.color), rms(all.color, by_chance));
    settings.transparency.list_nodes = 0;
    EXPECT_TRUE(is_same(smoke.picture(4, settings).color, by_chance));
}

TEST(Transparency, IsTheSameOnAnyNumberOfThreads) {
    for (const Transparency transparency : {Transparency::stochastic, Transparency::lists}) {
        VisibilitySettings settings = settings_of(64, transparency);
        settings.transparency.list_nodes = 40;
        const Scene scene = shipped_scene("panes");
        const VisibilityPicture one = Triangles(scene, 96, 54, 1).picture(4, settings);
        for (const int threads : {2, 5}) {
            const VisibilityPicture many = Triangles(scene, 96, 54, threads).picture(4, settings);
            EXPECT_TRUE(is_same(one.color, many.color));
            EXPECT_EQ(one.report.list_overflows, many.report.list_overflows);
            EXPECT_EQ(one.report.shadings, many.report.shadings);
        }
    }
}

TEST(Transparency, SortedAtEverySampleIsTheTruth) {
    const Triangles panes(shipped_scene("panes"), 96, 54);
    VisibilitySettings settings = settings_of(8, Transparency::sorted);
    settings.visibility = Visibility::supersampled;
    const VisibilityPicture sorted = panes.picture(4, settings);
    EXPECT_TRUE(is_same(sorted.color, panes.renderer().render_truth(4, truth_with(8))));
    EXPECT_GT(sorted.report.shadings, 96u * 54 * 8);
}

}  // namespace
}  // namespace aftershade::scene
