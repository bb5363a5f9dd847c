// Visibility and caches as compute shaders, against the CPU renderer and sets of ids.
#include "framework/visibility/gpu_visibility.h"

#include <algorithm>
#include <array>
#include <bit>
#include <set>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "framework/scene/triangulate.h"
#include "framework/visibility/gpu_cache.h"
#include "framework/visibility/gpu_scene.h"
#include "tests/gpu/gpu_test.h"
#include "tests/scene/alpha_file.h"
#include "tests/scene/scene_text.h"

namespace aftershade {
std::string_view visibility_trace_shader();
std::string_view visibility_trace_alpha_shader();
std::string_view visibility_light_samples_shader();
std::string_view visibility_light_samples_alpha_shader();
std::string_view visibility_shade_shader();
std::string_view visibility_shade_alpha_shader();
}  // namespace aftershade

namespace aftershade::visibility {
namespace {

using scene::kNoShading;

class VisibilityOn : public gpu::SoftwareTest {};
ON_EACH_BACKEND(VisibilityOn);

struct Traced {
    std::vector<std::uint32_t> on_cpu;
    std::vector<std::uint32_t> on_gpu;
    std::uint32_t id_count = 0;
};

constexpr int kWidth_px = 160, kHeight_px = 90;

Traced traced(Passes& passes, const scene::Scene& scene, int frame, int samples) {
    const scene::Scene triangles = scene::triangulated(scene);
    const scene::SceneRenderer renderer(triangles, kWidth_px, kHeight_px, 2);
    const scene::ShadingGrids grids(renderer, frame, {});
    scene::VisibilitySettings settings;
    settings.samples = samples;
    return {scene::trace_ids(renderer, grids, frame, settings),
            trace_ids(passes, renderer, grids, frame, settings), grids.id_count()};
}

Traced traced(Passes& passes, const std::string& id, int frame, int samples) {
    return traced(passes, scene::shipped_scene(id), frame, samples);
}

TEST(VisibilityShaders, NeedNoMoreStorageBlocksThanGlPromises) {
    constexpr int kPromised = 8;  // GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS of OpenGL 4.5, table 23.66
    for (const std::string_view shader :
         {visibility_trace_shader(), visibility_trace_alpha_shader(), visibility_light_samples_shader(),
          visibility_light_samples_alpha_shader(), visibility_shade_shader(),
          visibility_shade_alpha_shader()}) {
        int blocks = 0;
        for (std::size_t at = shader.find("layout(std430"); at != shader.npos;
             at = shader.find("layout(std430", at + 1))
            ++blocks;
        EXPECT_GE(blocks, 5);
        EXPECT_LE(blocks, kPromised);
    }
}

TEST_P(VisibilityOn, MeetsHolesAndMixedOpacitiesAsTheCpuDoes) {
    Passes passes(context());
    for (const std::string& mode : {scene::test::kBlend, scene::test::kMask}) {
        const scene::test::TemporaryFolder folder;
        const Traced found = traced(passes, scene::test::alpha_scene(folder.path(), mode), 1, 8);
        std::size_t other = 0;
        for (std::size_t i = 0; i < found.on_cpu.size(); ++i) other += found.on_cpu[i] != found.on_gpu[i];
        EXPECT_LT(double(other) / double(found.on_cpu.size()), 0.003) << mode;
    }
}

TEST_P(VisibilityOn, MeetsWhatTheCpuMeetsButAtEdges) {
    Passes passes(context());
    for (const auto& [id, frame] : {std::pair("bats", 6), {"toys", 4}, {"camera_checker", 6}, {"panes", 4}}) {
        const Traced found = traced(passes, id, frame, 8);
        ASSERT_EQ(found.on_gpu.size(), found.on_cpu.size());
        std::size_t other = 0;
        for (std::size_t i = 0; i < found.on_cpu.size(); ++i) other += found.on_cpu[i] != found.on_gpu[i];
        EXPECT_LT(double(other) / double(found.on_cpu.size()), 0.002) << id;
    }
}

/// Whether the leaf of an object in the upper hierarchy holds a point.
bool holds(const std::vector<GpuNode>& top, std::uint32_t object, const glm::vec3& point) {
    for (const GpuNode& node : top) {
        const auto items = std::bit_cast<std::uint32_t>(node.high_items.w);
        if (items != (object << 3 | 1u)) continue;
        return glm::all(glm::lessThanEqual(glm::vec3(node.low_skip), point)) &&
               glm::all(glm::lessThanEqual(point, glm::vec3(node.high_items)));
    }
    return false;
}

TEST(UpperHierarchy, HoldsEachObjectAtEveryMomentOfASampleAndNoMore) {
    const scene::Scene triangles = scene::triangulated(scene::shipped_scene("toys"));
    const scene::SceneRenderer renderer(triangles, kWidth_px, kHeight_px, 2);
    scene::VisibilitySettings settings;
    settings.samples = 8;
    const auto sources = gpu_sources(triangles);
    double lengths_m[2] = {};
    for (const int sample : {0, 7}) {
        const auto moments = renderer.moments_of(4, truth_of(settings), sample);
        ASSERT_GT(moments.size(), 1u);
        const std::vector<GpuNode> top = make_top(renderer, moments);
        EXPECT_EQ(std::bit_cast<std::uint32_t>(top.front().low_skip.w), top.size());
        for (const auto& [object, triangle] : sources)
            for (const scene::World& world : moments) {
                const scene::Mesh& mesh = triangles.meshes[std::size_t(triangles.objects[object].shape.mesh)];
                const glm::dvec3& corner = mesh.vertices[mesh.triangles[triangle][0]].position;
                const glm::dvec3 at(world.state().world_from_object[object] * glm::dvec4(corner, 1));
                ASSERT_TRUE(holds(top, object, glm::vec3(at))) << object << " " << triangle;
            }
        // One moment alone needs no more room than all of them.
        const std::vector<GpuNode> one = make_top(renderer, {moments.front()});
        EXPECT_EQ(one.size(), top.size());
        const auto diagonal = [](const std::vector<GpuNode>& nodes) {
            double sum = 0;
            for (const GpuNode& node : nodes)
                sum += double(glm::length(glm::vec3(node.high_items) - glm::vec3(node.low_skip)));
            return sum;
        };
        EXPECT_LT(diagonal(one), diagonal(top));
        lengths_m[sample == 0 ? 0 : 1] = diagonal(top);
    }
    EXPECT_NE(lengths_m[0], lengths_m[1]) << "each sample has a hierarchy of its own";
}

TEST_P(VisibilityOn, CountsTheShadingsThatASetCounts) {
    Passes passes(context());
    const Traced found = traced(passes, "toys", 4, 64);
    const scene::SampleIds samples{found.on_gpu, kWidth_px, kHeight_px, 64};
    std::unordered_set<std::uint32_t> all;
    std::set<std::array<std::size_t, 3>> of_tiles;
    for (std::size_t i = 0; i < found.on_gpu.size(); ++i) {
        if (found.on_gpu[i] == kNoShading) continue;
        const std::size_t pixel = i / 64;
        all.insert(found.on_gpu[i]);
        of_tiles.insert({pixel % kWidth_px / 16, pixel / kWidth_px / 16, found.on_gpu[i]});
    }
    const CacheCounts global = fill_tables(passes, samples, found.id_count, 0).counts;
    EXPECT_EQ(global.shadings, all.size());
    EXPECT_EQ(global.overflows, 0u);
    const CacheCounts tiles = fill_tables(passes, samples, found.id_count, 16).counts;
    EXPECT_EQ(tiles.shadings, of_tiles.size());
    EXPECT_EQ(tiles.overflows, 0u);
    EXPECT_EQ(tiles.requests, scene::replay(samples, {}).requests);
}

TEST_P(VisibilityOn, IsTheSameInBandsOfRows) {
    Passes passes(context());
    const scene::Scene triangles = scene::triangulated(scene::shipped_scene("toys"));
    const scene::SceneRenderer renderer(triangles, kWidth_px, kHeight_px, 2);
    const scene::ShadingGrids grids(renderer, 4, {});
    scene::VisibilitySettings settings;
    settings.samples = 4;
    const auto whole = trace_ids(passes, renderer, grids, 4, settings);
    // 20 rows of rays at 32 bytes a pixel.
    EXPECT_EQ(trace_ids(passes, renderer, grids, 4, settings, 20 * kWidth_px * 32), whole);
    const scene::SampleIds samples{whole, kWidth_px, kHeight_px, 4};
    for (const int tile_px : {0, 8}) {
        const CacheCounts once = fill_tables(passes, samples, grids.id_count(), tile_px).counts;
        const CacheCounts in_bands = fill_tables(passes, samples, grids.id_count(), tile_px, 150000).counts;
        EXPECT_EQ(in_bands.overflows, 0u);
        EXPECT_EQ(in_bands.shadings, once.shadings);
        EXPECT_EQ(in_bands.requests, once.requests);
    }
}

TEST_P(VisibilityOn, EndsWithCountedOverflowsWhereATableIsTooSmall) {
    Passes passes(context());
    // Half a million ids are said to be 64: all places are taken, and each attempt ends.
    std::vector<std::uint32_t> ids(std::size_t(64) * 64 * 128);
    for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = std::uint32_t(i);
    const CacheCounts counts = fill_tables(passes, {ids, 64, 128, 64}, 64, 0).counts;
    EXPECT_EQ(counts.requests, ids.size());
    EXPECT_EQ(counts.shadings, ids.size());
    EXPECT_EQ(counts.overflows, ids.size() - 128);
}

TEST_P(VisibilityOn, KeepsIdsInLockedBucketsAndEndsWhateverTheirNumber) {
    Passes passes(context());
    constexpr int kSamples = 16;
    const Traced found = traced(passes, "toys", 4, kSamples);
    const scene::SampleIds samples{found.on_gpu, kWidth_px, kHeight_px, kSamples};
    std::unordered_set<std::uint32_t> all(found.on_gpu.begin(), found.on_gpu.end());
    all.erase(kNoShading);
    const std::uint64_t requests = scene::replay(samples, {}).requests;
    // Sixteen places for each id: no bucket drops any.
    const CacheCounts roomy = fill_buckets(passes, samples, int(16 * all.size()), 16).counts;
    EXPECT_EQ(roomy.requests, requests);
    EXPECT_LE(roomy.shadings - roomy.overflows, all.size());
    EXPECT_GE(roomy.shadings, all.size());
    EXPECT_LT(double(roomy.overflows), 0.001 * double(requests));
    // Tile by tile, as on the CPU. Row by row, light is dropped before the next row asks for it. How many
    // pixels ask at once differs from GPU to GPU.
    const scene::ShadingCacheSettings fifo{scene::ShadingCache::fifo, 16, 256};
    const CacheCounts tight = fill_buckets(passes, samples, fifo.entries, fifo.tile_px).counts;
    EXPECT_EQ(tight.requests, requests);
    EXPECT_GT(tight.shadings, all.size());
    EXPECT_LT(double(tight.shadings),
              0.9 * double(fill_buckets(passes, samples, fifo.entries, 1).counts.shadings));
    EXPECT_LT(double(tight.shadings), 2.5 * double(scene::replay(samples, fifo).shadings));
    const CacheCounts one = fill_buckets(passes, samples, 1, 16).counts;
    EXPECT_EQ(one.requests, requests);
    EXPECT_LE(one.shadings, requests);
    EXPECT_GT(one.shadings, tight.shadings);
}

}  // namespace
}  // namespace aftershade::visibility
