// `render --visibility-on gl`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "framework/gpu/context.h"
#include "framework/scene/visibility.h"
#include "framework/visibility/gpu_cache.h"
#include "framework/visibility/passes.h"

namespace aftershade::cli {

/// Traces ids, fills caches with them and resolves their light with GL; or lights every sample.
/// [the thread that made it]
class GlVisibility {
public:
    explicit GlVisibility(const gpu::GlChoice& gl) : context_(gl), passes_(context_) {}
    const gpu::ContextInfo& info() const { return context_.info(); }
    /// This must outlive them.
    scene::VisibilityPasses passes();
    /// The renderer, the time of each pass over all frames and, for each memoised frame, what its caches
    /// counted.
    nlohmann::ordered_json json() const;

private:
    scene::CacheReplay fill(const scene::SampleIds& samples, const scene::ShadingGrids& grids,
                            const scene::ShadingCacheSettings& cache);

    gpu::Context context_;
    visibility::Passes passes_;
    std::vector<visibility::CacheCounts> counts_;
};

}  // namespace aftershade::cli
