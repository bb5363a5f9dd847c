// The checks of FrameGraph. Internal to framework/graph.
#pragma once

#include <string_view>

#include "framework/graph/frame_graph.h"

namespace aftershade::graph {

/// Throws GraphError naming the pass and the texture or buffer if `pass` cannot be the next one of `graph`.
void check_pass(const FrameGraph& graph, const Pass& pass);

/// The texture of a handle. Throws GraphError, which begins with `user`, for a handle that the graph never
/// gave or that a later write made stale.
const FrameGraph::Texture& live(const FrameGraph& graph, TextureHandle handle, std::string_view user);
const FrameGraph::Buffer& live(const FrameGraph& graph, BufferHandle handle, std::string_view user);

}  // namespace aftershade::graph
