// Inputs that a graph receives before its passes run: images, parameters, uniform blocks.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "framework/graph/executor.h"
#include "framework/render/frame_blocks.h"
#include "framework/render/graph_key.h"
#include "framework/render/step_files.h"

namespace aftershade {

/// An image of the capture before (-1), of (0) or after (+1) the frame.
struct CaptureBinding {
    RoleId role;
    int offset = 0;
    graph::TextureHandle texture;
};

/// The picture of a step's mask.
struct MaskBinding {
    int step = 0;
    graph::TextureHandle texture;
    bool is_given = false;  ///< it never changes
};

/// The texture, the buffer or both that a parameter fills.
struct ParamBinding {
    int step = 0;
    const ParamSpec* spec = nullptr;
    std::optional<graph::TextureHandle> texture{};
    std::optional<graph::BufferHandle> buffer{};
    std::optional<ParamValue> given{};  ///< what they hold
};

/// A table that native code computes.
struct NativeTableBinding {
    int step = 0;
    std::string table;
    graph::TextureHandle texture;
};

/// The uniform blocks whose contents change from frame to frame.
enum class BlockKind { param, frame, camera, lights, native, mix };

/// A uniform block of a pass of the graph.
struct BlockPlace {
    int pass = 0;
    int binding = 0;
};

/// A block, the same in each of some passes.
struct BlockBinding {
    BlockKind kind = BlockKind::param;
    int step = 0;                    ///< of a camera, which is that of all steps on its grid: the first one
    std::vector<BlockPlace> places;  ///< by the pass's index in the graph, rising
};

/// Where a shader declares the block.
int gl_binding(BlockKind kind);
/// Its size, the same for every frame.
std::size_t block_bytes(BlockKind kind, const EffectManifest& manifest);

using GraphBinding =
    std::variant<CaptureBinding, ParamBinding, MaskBinding, NativeTableBinding, BlockBinding>;

/// Where the contents come from. [refers to what the caller keeps]
struct GraphFeed {
    GraphFrame frame;
    FrameBefore before;
    StepFiles& files;
    int first_pass = 0;          ///< blocks of passes before it stay as they are
    bool same_captures = false;  ///< their images are in place already
};

/// Puts the frame's content into what is bound; textures and buffers of files, curves and tables only where
/// it changed. Throws Error(ErrorKind::effect) for an image that does not fit its role,
/// Error(ErrorKind::capture) for lights and mixes that the capture does not give.
void give(GraphBinding& binding, const GraphFeed& feed, graph::Executor& executor);

}  // namespace aftershade
