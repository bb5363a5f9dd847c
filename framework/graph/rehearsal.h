// A pass drawn over a few texels, for what the driver compiles at the first draw: llvmpipe makes a program's
// machine code then, by the formats and filters that are bound.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "framework/graph/frame_graph.h"

namespace aftershade::graph {

/// The bindings of a pass without their content: textures of a few texels whose sides are powers of two where
/// those of the graph are, since the code that fetches from them differs.
struct PassShape {
    /// `memory`: the format of the memory, of which the texture is a view where its own differs.
    struct Texels {
        gpu::TextureDesc desc;
        gpu::TextureFormat memory;
    };
    struct Sampled {
        Texels texture;
        int binding = 0;
        gpu::Filter filter = gpu::Filter::nearest;
        gpu::Wrap wrap = gpu::Wrap::clamp;
        std::optional<int> level{};
    };
    struct Drawn {
        Texels texture;
        int level = 0;
        int layer = 0;
        bool fills_mips = false;  ///< levels 1.. are filled after the pass
    };
    struct Image {
        Texels texture;
        int binding = 0;
        gpu::Access access = gpu::Access::read;
    };
    struct Memory {
        std::size_t bytes = 0;
        int binding = 0;
    };
    PassKind kind = PassKind::draw;
    std::vector<Sampled> reads{};
    std::vector<Drawn> targets{};
    std::vector<Image> images{};
    std::vector<Memory> buffers{};
    std::vector<Memory> uniforms{};
    gpu::Blend blend = gpu::Blend::none;
    gpu::Primitive primitive = gpu::Primitive::quads;
    std::optional<int> first_target_unit{};  ///< as Pass's
};

/// `compiled`: the graph's memory.
PassShape shape_of(const FrameGraph& graph, const CompiledGraph& compiled, const Pass& pass);

/// Draws or dispatches once over memory that holds zeros. Nothing for a clear. Throws what gpu::draw() does.
/// [the context's thread]
void rehearse(gpu::Context& context, const gpu::Program& program, const PassShape& shape);

/// Has a driver that makes machine code at a program's first draw or dispatch make it now, for each pass that
/// `compiled` does not cull: rehearses it with nothing to do. Does nothing on hardware. [the context's
/// thread]
void prime(gpu::Context& context, const FrameGraph& graph, const CompiledGraph& compiled);

}  // namespace aftershade::graph
