// Light at every visibility sample as a compute shader, against the CPU renderer in double precision.
#include "framework/visibility/gpu_samples.h"

#include <cmath>
#include <vector>

#include "framework/scene/triangulate.h"
#include "tests/gpu/gpu_test.h"
#include "tests/scene/alpha_file.h"
#include "tests/scene/scene_text.h"

namespace aftershade::visibility {
namespace {

class SamplesOn : public gpu::SoftwareTest {};
ON_EACH_BACKEND(SamplesOn);

constexpr glm::ivec2 kSize_px(64, 36);

scene::LitSamples on_cpu(const scene::Scene& triangles, int frame,
                         const scene::VisibilitySettings& settings) {
    return scene::light_samples(scene::SceneRenderer(triangles, kSize_px.x, kSize_px.y, 2), frame, settings);
}

scene::LitSamples on_gl(gpu::Context& context, const scene::Scene& triangles, int frame,
                        const scene::VisibilitySettings& settings,
                        std::size_t max_buffer_bytes = kMaxBufferBytes) {
    Passes passes(context);
    return light_samples(passes, scene::SceneRenderer(triangles, kSize_px.x, kSize_px.y, 2), frame, settings,
                         max_buffer_bytes);
}

/// The share of pixels in which a channel differs by more than a thousandth of its value and of 0.1.
double other_pixels(const scene::LitSamples& a, const scene::LitSamples& b) {
    int other = 0;
    for (std::size_t i = 0; i < a.sums.size(); ++i) {
        const glm::dvec3 limit = 1e-3 * (glm::abs(a.sums[i]) + 0.1);
        other += glm::all(glm::lessThanEqual(glm::abs(a.sums[i] - b.sums[i]), limit)) ? 0 : 1;
    }
    return other / double(a.sums.size());
}

TEST_P(SamplesOn, AreLitAsTheCpuLightsThemAtTheirOwnMoments) {
    for (const auto visibility : {scene::Visibility::supersampled, scene::Visibility::accumulation})
        for (const auto& [id, frame] :
             {std::pair("bats", 6), {"toys", 4}, {"panes", 4}, {"light_flash", 4}, {"urn", 4}}) {
            scene::Scene triangles = scene::triangulated(scene::shipped_scene(id));
            triangles.ambient_rays = 3;
            scene::VisibilitySettings settings;
            settings.visibility = visibility;
            settings.samples = 2;
            const scene::LitSamples expected = on_cpu(triangles, frame, settings);
            const scene::LitSamples found = on_gl(context(), triangles, frame, settings);
            EXPECT_LT(other_pixels(expected, found), 0.02) << id;
            std::uint64_t met = 0, met_otherwise = 0;
            for (std::size_t i = 0; i < expected.met.size(); ++i) {
                met += expected.met[i];
                met_otherwise += expected.met[i] != found.met[i] ? 1 : 0;
            }
            EXPECT_GT(met, 0u) << id;
            EXPECT_LT(double(met_otherwise), 0.002 * double(met)) << id;
        }
}

TEST_P(SamplesOn, GoThroughAlphaAsOnTheCpu) {
    for (const std::string& mode : {scene::test::kBlend, scene::test::kMask}) {
        const scene::test::TemporaryFolder folder;
        scene::Scene triangles = scene::triangulated(scene::test::alpha_scene(folder.path(), mode));
        triangles.ambient_rays = 3;
        scene::VisibilitySettings settings;
        settings.visibility = scene::Visibility::supersampled;
        settings.samples = 4;
        const scene::LitSamples expected = on_cpu(triangles, 1, settings);
        const scene::LitSamples found = on_gl(context(), triangles, 1, settings);
        // Where a sample stops by chance, the last digit of an opacity decides.
        EXPECT_LT(other_pixels(expected, found), 0.03) << mode;
    }
}

TEST_P(SamplesOn, AreTheSameInBands) {
    const scene::Scene triangles = scene::triangulated(scene::shipped_scene("toys"));
    scene::VisibilitySettings settings;
    settings.visibility = scene::Visibility::supersampled;
    settings.samples = 3;
    const scene::LitSamples whole = on_gl(context(), triangles, 4, settings);
    // Five rows of rays at 48 bytes a pixel.
    const scene::LitSamples in_bands = on_gl(context(), triangles, 4, settings, 5 * 64 * 48);
    EXPECT_EQ(other_pixels(whole, in_bands), 0);
    EXPECT_EQ(whole.met, in_bands.met);
}

}  // namespace
}  // namespace aftershade::visibility
