#include "cli/gl_visibility.h"

#include <nlohmann/json.hpp>

namespace aftershade::cli {

scene::IdTracer GlVisibility::tracer() {
    return [this](const scene::SceneRenderer& renderer, const scene::ShadingGrids& grids, int frame,
                  const scene::VisibilitySettings& settings) {
        std::vector<std::uint32_t> ids = visibility::trace_ids(context_, renderer, grids, frame, settings);
        const scene::ShadingCacheSettings& cache = settings.cache;
        const bool is_of_tiles =
            cache.cache == scene::ShadingCache::tile || cache.cache == scene::ShadingCache::sorted;
        const scene::SampleIds samples{ids, renderer.width_px(), renderer.height_px(), settings.samples};
        counts_.push_back(cache.cache == scene::ShadingCache::fifo
                              ? visibility::count_shadings_in_buckets(context_, samples, cache.entries)
                              : visibility::count_shadings(context_, samples, grids.id_count(),
                                                           is_of_tiles ? cache.tile_px : 0));
        return ids;
    };
}

nlohmann::ordered_json GlVisibility::counts_json() const {
    auto frames = nlohmann::ordered_json::array();
    for (const visibility::CacheCounts& counts : counts_)
        frames.push_back({{"hits", counts.requests - counts.shadings},
                          {"misses", counts.shadings},
                          {"overflows", counts.overflows}});
    return {{"renderer", context_.info().renderer}, {"frames", frames}};
}

}  // namespace aftershade::cli
