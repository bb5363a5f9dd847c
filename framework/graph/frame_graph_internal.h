// The checks of FrameGraph, and which versions a pass needs and makes. Internal to framework/graph.
#pragma once

#include <string_view>
#include <vector>

#include "framework/graph/frame_graph.h"

namespace aftershade::graph {

/// Throws GraphError naming the pass and the texture or buffer if `pass` cannot be the next one of `graph`.
void check_pass(const FrameGraph& graph, const Pass& pass);

/// The texture of a handle. Throws GraphError, which begins with `user`, for a handle that the graph never
/// gave or that a later write made stale.
const FrameGraph::Texture& live(const FrameGraph& graph, TextureHandle handle, std::string_view user);
const FrameGraph::Buffer& live(const FrameGraph& graph, BufferHandle handle, std::string_view user);

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
