// Runs a compiled graph, frame after frame, in the same memory.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "framework/gpu/buffer.h"
#include "framework/gpu/texture.h"
#include "framework/graph/frame_graph.h"

namespace aftershade::graph {

struct PassTime {
    std::string pass;
    double milliseconds = 0;
};

/// [the context's thread]
class Executor {
public:
    /// Allocates every texture and uniform buffer. Throws Error(ExitCode::effect) when GL has no memory for them.
    Executor(gpu::Context& context, FrameGraph graph);

    const CompiledGraph& compiled() const { return compiled_; }
    /// The texture behind an imported or kept handle; nullptr for one that no pass needs.
    gpu::Texture* texture(TextureHandle handle);
    /// Replaces the content of a uniform block of a pass; `bytes` has the size that the pass was added with.
    void set_uniforms(int pass, int binding, std::vector<std::byte> bytes);

    /// Runs every pass. With `timed`, waits for each and returns its milliseconds (see gpu::Timer); else returns {}.
    std::vector<PassTime> run(bool timed);

private:
    void run_pass(int index);

    gpu::Context& context_;
    FrameGraph graph_;
    CompiledGraph compiled_;
    std::vector<gpu::Texture> slots_;
    std::map<std::pair<int, int>, gpu::Buffer> uniforms_;  // by pass and binding
};

}  // namespace aftershade::graph
