// The programs of a graph's passes, which are made once all passes are known: some run as one.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "framework/core/status.h"
#include "framework/effect/pass_program.h"
#include "framework/graph/fusion.h"
#include "framework/pipeline/graph_bindings.h"
#include "framework/pipeline/pipeline.h"

namespace aftershade {

/// A pass that is worked on in the frame that `status`, which may be null, is at.
WorkStatus status_of_pass(const PipelineStep& step, const std::string& pass, const std::string& phase,
                          const StatusWriter* status);

/// [refers to what the caller keeps]
class PassPrograms {
public:
    struct Tools {
        ProgramCache& programs;
        StatusWriter* status = nullptr;  ///< receives which pass is compiled; may be null
        bool fuses = true;
    };
    explicit PassPrograms(const Tools& tools) : tools_(tools) {}

    /// The pass that will have this index in the graph.
    void add(int pass, const ShaderContext& shader, const PipelineStep& step);
    /// Gives the graph's passes their programs. Fused ones take the place of the last of theirs, and `blocks`
    /// point to them. `divide_at`: no pass from this index on joins one before it. Throws
    /// Error(ExitCode::effect) for the faults of a shader.
    void finish(graph::FrameGraph& graph, std::vector<BlockBinding>& blocks, int divide_at);

private:
    struct Added {
        ShaderContext shader;
        const PipelineStep* step = nullptr;
    };
    void fuse(graph::FrameGraph& graph, const graph::Fusion& fusion, std::vector<BlockBinding>& blocks);
    int blocks_of(const graph::FrameGraph& graph, int pass);
    int count_blocks(const graph::FrameGraph& graph, int pass);
    const std::vector<int>& unused_blocks_of(int pass);
    WorkStatus compiling(const Added& added, const std::string& pass) const;

    Tools tools_;
    std::map<int, Added> added_;              // by pass
    std::map<int, std::vector<int>> unused_;  // uniform blocks, by pass
    std::map<int, int> block_counts_;         // likewise
};

}  // namespace aftershade
