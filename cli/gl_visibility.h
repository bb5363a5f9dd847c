// `render --visibility memoised --visibility-on gl`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "framework/gpu/context.h"
#include "framework/scene/visibility.h"
#include "framework/visibility/gpu_visibility.h"

namespace aftershade::cli {

/// Traces ids with GL, and has its caches count them too. [the thread that made it]
class GlVisibility {
public:
    explicit GlVisibility(gpu::Backend backend) : context_(backend) {}
    /// This must outlive it.
    scene::IdTracer tracer();
    /// For each frame, the renderer and what its caches counted.
    nlohmann::ordered_json counts_json() const;

private:
    gpu::Context context_;
    std::vector<visibility::CacheCounts> counts_;
};

}  // namespace aftershade::cli
