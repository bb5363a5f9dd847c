#include "cli/gl_visibility.h"

#include <nlohmann/json.hpp>

#include "framework/visibility/gpu_light.h"
#include "framework/visibility/gpu_samples.h"
#include "framework/visibility/gpu_visibility.h"

namespace aftershade::cli {

scene::VisibilityPasses GlVisibility::passes() {
    scene::VisibilityPasses passes;
    passes.trace = [this](const scene::SceneRenderer& renderer, const scene::ShadingGrids& grids, int frame,
                          const scene::VisibilitySettings& settings) {
        return visibility::trace_ids(passes_, renderer, grids, frame, settings);
    };
    passes.fill = [this](const scene::SampleIds& samples, const scene::ShadingGrids& grids,
                         const scene::ShadingCacheSettings& cache) { return fill(samples, grids, cache); };
    passes.resolve = [this](const scene::SceneRenderer& renderer, const scene::ShadingGrids& grids,
                            std::span<const std::uint32_t> ids, const scene::SampleIds& addresses) {
        return visibility::resolve_light(passes_, renderer, grids, ids, addresses);
    };
    passes.light = [this](const scene::SceneRenderer& renderer, int frame,
                          const scene::VisibilitySettings& settings) {
        return visibility::light_samples(passes_, renderer, frame, settings);
    };
    return passes;
}

scene::CacheReplay GlVisibility::fill(const scene::SampleIds& samples, const scene::ShadingGrids& grids,
                                      const scene::ShadingCacheSettings& cache) {
    const bool is_of_tiles =
        cache.cache == scene::ShadingCache::tile || cache.cache == scene::ShadingCache::sorted;
    visibility::FilledCache filled =
        cache.cache == scene::ShadingCache::fifo
            ? visibility::fill_buckets(passes_, samples, cache.entries, cache.tile_px)
            : visibility::fill_tables(passes_, samples, grids.id_count(), is_of_tiles ? cache.tile_px : 0);
    counts_.push_back(filled.counts);
    return std::move(filled.replay);
}

nlohmann::ordered_json GlVisibility::json() const {
    auto frames = nlohmann::ordered_json::array();
    for (const visibility::CacheCounts& counts : counts_)
        frames.push_back({{"hits", counts.requests - counts.shadings},
                          {"misses", counts.shadings},
                          {"overflows", counts.overflows}});
    return {{"renderer", passes_.context().info().renderer},
            {"passes_ms", passes_.milliseconds()},
            {"frames", frames}};
}

}  // namespace aftershade::cli
