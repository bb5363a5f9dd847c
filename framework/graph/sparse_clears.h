// Clears textures only where they were drawn to before. Internal to framework/graph.
#pragma once

#include <optional>
#include <vector>

#include "framework/gpu/buffer.h"
#include "framework/gpu/commands.h"
#include "framework/gpu/texture.h"
#include "framework/graph/frame_graph.h"
#include "framework/graph/pass_range.h"

namespace aftershade::graph {

/// Performs CompiledGraph::sparse from frame to frame. On software GL a clear writes every texel, and tile
/// lists leave most of them as they are. [the context's thread; refers to what the executor keeps]
class SparseClears {
public:
    SparseClears(gpu::Context& context, const FrameGraph& graph, const CompiledGraph& compiled,
                 std::vector<gpu::Texture>& slots, std::vector<gpu::Buffer>& buffer_slots);

    /// These passes run next. A texture of which they are a part alone is cleared as a whole from then on
    /// until all its passes run at once.
    void begin(PassRange range);
    /// At the texture's first use in these passes, before which it is to be cleared: whether wiping did that.
    /// From then on passes draw to it.
    bool wipe(int texture);
    /// The pass has run: notes where it drew.
    void note_places(int pass);
    /// Something else than the passes has changed textures.
    void forget();

private:
    /// Where a pass drew to a texture last.
    struct Drawn {
        gpu::Buffer places;
        std::optional<gpu::Buffer> instances;
    };
    /// One memory of a texture; that of a history has two, which change places.
    struct Memory {
        unsigned int handle = 0;
        bool is_known = false;       ///< it holds its clear value but for what each of its passes last drew
        std::vector<Drawn> drawn{};  ///< as SparseTexture::places
    };
    struct BoundWipe {
        const Wipe* wipe = nullptr;
        int pass = 0;
        gpu::Buffer uniforms;
        const gpu::Buffer* places = nullptr;
        const gpu::Buffer* next_places = nullptr;  ///< where the texture will be drawn over
        std::optional<gpu::Buffer> no_places{};    ///< in their stead, where they are not known in time
        gpu::Target target;
        gpu::InstanceRange instances;
    };
    struct Tracked {
        const SparseTexture* texture = nullptr;
        const gpu::Texture* slot = nullptr;
        bool is_due = false;    // to be cleared in these passes, which are all that use it
        bool is_fresh = false;  // cleared, and not all of its passes have drawn yet
        std::vector<BoundWipe> wipes{};
        std::vector<Memory> memories{};
    };

    Memory& memory_of(Tracked& tracked);
    void draw(const BoundWipe& bound, const Drawn& drawn);

    gpu::Context& context_;
    std::vector<Tracked> tracked_;
};

}  // namespace aftershade::graph
