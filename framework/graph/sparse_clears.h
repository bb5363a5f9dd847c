// Clears textures only where the frame before drew to them. Internal to framework/graph.
#pragma once

#include <vector>

#include "framework/gpu/buffer.h"
#include "framework/gpu/commands.h"
#include "framework/gpu/texture.h"
#include "framework/graph/frame_graph.h"
#include "framework/graph/pass_range.h"

namespace aftershade::graph {

/// What CompiledGraph::sparse says, from frame to frame. On software GL a clear writes every texel, and tile
/// lists leave most of them as they are. [the context's thread; refers to what the executor keeps]
class SparseClears {
public:
    SparseClears(gpu::Context& context, const FrameGraph& graph, const CompiledGraph& compiled,
                 std::vector<gpu::Texture>& slots, std::vector<gpu::Buffer>& buffer_slots);

    /// These passes run next. A texture of which they are a part alone is cleared as a whole from then on
    /// until all its passes run at once.
    void begin(PassRange range);
    /// Wipes what is due before this pass, which may overwrite where the frame before drew.
    void wipe_before(int pass);
    /// The texture's first use: whether it holds its clear value already. From then on passes draw to it.
    bool is_clear(int texture);

private:
    /// Of a texture's content.
    enum class State {
        unknown,
        drawn_once,  ///< its clear value but for what each of its passes last drew
        clear
    };
    struct BoundWipe {
        const Wipe* wipe = nullptr;
        gpu::Buffer uniforms;
        const gpu::Buffer* places = nullptr;
        gpu::Target target;
        gpu::InstanceRange instances;
    };
    struct Tracked {
        const SparseTexture* texture = nullptr;
        State state = State::unknown;
        bool is_due = false;
        std::vector<BoundWipe> wipes;
    };

    void draw(const BoundWipe& bound);

    gpu::Context& context_;
    std::vector<Tracked> tracked_;
};

}  // namespace aftershade::graph
