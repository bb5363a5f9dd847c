// Which versions a pass needs and makes. Internal to framework/graph.
#pragma once

#include <vector>

#include "framework/graph/frame_graph.h"

namespace aftershade::graph {

/// A texture, by its index, or a buffer, by its index plus the number of textures, as it is after a write.
struct Version {
    int resource = -1;
    int version = 0;
};

struct PassUses {
    std::vector<Version> needs;  ///< with what was there before a write that keeps some of it
    std::vector<Version> makes;
};

PassUses uses_of(const FrameGraph& graph, int pass);

}  // namespace aftershade::graph
