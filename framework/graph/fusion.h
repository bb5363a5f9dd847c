// Which draws of a graph can run as one: each hands its pixel to the next in a register instead of a texture.
#pragma once

#include <functional>
#include <vector>

#include "framework/graph/frame_graph.h"

namespace aftershade::graph {

/// Limits of a fused pass, over all its parts.
struct FusionLimits {
    int parts = 8;
    int samplers = 16;
    int buffers = 8;
    int blocks = 14;
    int targets = 8;
};

struct FusionOptions {
    FusionLimits limits{};
    int divide_at = 0;  ///< passes before this index join none from it on
    /// Uniform blocks that the program of a pass needs; above the limit for one that cannot be a part.
    std::function<int(int pass)> blocks;
};

/// One fused pass to be.
struct Fusion {
    std::vector<int> passes;             ///< by rising index; at least two
    std::vector<TextureHandle> targets;  ///< what of their results something else needs
};

/// Groups the passes that `compiled` runs. A later pass joins the one that makes what it reads by the
/// pixel, if nothing that lies between needs the results earlier, or changes what the earlier ones read, and
/// if memory would keep every bit of the texel. Results that others need, too, stay targets.
std::vector<Fusion> find_fusions(const FrameGraph& graph, const CompiledGraph& compiled,
                                 const FusionOptions& options);

}  // namespace aftershade::graph
