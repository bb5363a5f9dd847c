// Runs a compiled graph, frame after frame, in the same memory.
#pragma once

#include <functional>
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
    /// Allocates every texture and uniform buffer. Throws Error(ExitCode::effect) when GL has no memory for
    /// them.
    Executor(gpu::Context& context, FrameGraph graph);

    const CompiledGraph& compiled() const { return compiled_; }
    /// The texture behind an imported or kept handle; nullptr for one that no pass needs.
    gpu::Texture* texture(TextureHandle handle);
    gpu::Buffer* buffer(BufferHandle handle);
    /// Replaces the content of a uniform block of a pass; `bytes` has the size that the pass was added with.
    void set_uniforms(int pass, int binding, std::vector<std::byte> bytes);

    /// What a pass has just written: its name and its targets, by their names in the graph.
    using PassObserver =
        std::function<void(const std::string& pass, const std::string& texture, const gpu::Texture& target)>;

    /// Runs every pass. With `timed`, waits for each and returns its milliseconds (see gpu::Timer); else
    /// returns {}. `observer`, if any, sees each target right after its pass; its time is nobody's.
    /// At the end, each history that was written becomes what the next run reads as its `previous`.
    std::vector<PassTime> run(bool timed, const PassObserver& observer = {});

    /// What the next run will read as `previous`, by the history's name; only those that some pass reads.
    struct History {
        std::map<std::string, gpu::Texture*> textures;
        std::map<std::string, gpu::Buffer*> buffers;
    };
    History history();
    /// Sets every `previous` to zero: a cut, a gap, the first frame.
    void clear_history();
    /// Takes the histories over whose name and description are those of `other`, for a graph that was built
    /// anew between two frames; returns the names of those that found none.
    std::vector<std::string> take_history_from(Executor& other);

private:
    void run_pass(int index);

    gpu::Context& context_;
    FrameGraph graph_;
    CompiledGraph compiled_;
    std::vector<gpu::Texture> slots_;
    std::map<std::pair<int, int>, gpu::Buffer> uniforms_;  // by pass and binding
};

}  // namespace aftershade::graph
