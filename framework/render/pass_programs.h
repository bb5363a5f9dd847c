// The programs of a graph's passes, which are made once all passes are known: some run as one.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "framework/base/status.h"
#include "framework/effect/pass_program.h"
#include "framework/graph/fusion.h"
#include "framework/look/pipeline.h"
#include "framework/render/compile_ahead.h"
#include "framework/render/graph_bindings.h"

namespace aftershade {

/// A pass that is worked on in the frame that `status`, which may be null, is at.
WorkStatus status_of_pass(const PipelineStep& step, const std::string& pass, const std::string& phase,
                          const StatusWriter* status);

/// [refers to what the caller keeps]
class PassPrograms {
public:
    struct Tools {
        gpu::Context& context;
        ProgramCache& programs;
        StatusWriter* status = nullptr;  ///< receives which pass is compiled; may be null
        bool fuses = true;
        bool shares_memory = true;  ///< among the graph's textures
        /// Whether passes that nothing needs get programs, too, so that the faults of their shaders are
        /// found.
        bool compiles_culled = false;
        int compile_threads = 0;   ///< beside the caller's
        bool computes = false;     ///< draws become compute shaders where they can
        bool loads_images = true;  ///< fetches become loads from images where that is faster
    };
    explicit PassPrograms(const Tools& tools) : tools_(tools) {}

    /// Content of shaders' files.
    ShaderTexts& texts() { return texts_; }
    /// The pass that will have this index in the graph.
    void add(int pass, const ShaderContext& shader, const PipelineStep& step);
    /// Gives a draw over all of its targets a program of glsl/host.
    void give_host(const graph::FrameGraph& graph, graph::Pass& pass, const std::string& file,
                   const std::vector<std::string>& defines) const;
    /// Gives the graph's passes their programs. Fused ones take the place of the last of theirs, and `blocks`
    /// point to them. `divide_at`: no pass from this index on joins one before it. Throws
    /// Error(ErrorKind::effect) for the faults of a shader.
    void finish(graph::FrameGraph& graph, std::vector<BlockBinding>& blocks, int divide_at);
    /// After finish(): what still compiles for the first draws; nullptr where nothing does.
    std::unique_ptr<CompileAhead> take_ahead() { return std::move(ahead_); }

private:
    struct Added {
        ShaderContext shader;
        const PipelineStep* step = nullptr;
    };
    bool is_compiled(const graph::FrameGraph& graph, int pass) const;
    struct Form;
    struct Assembled;
    struct FusedAssembled;
    std::vector<FusedAssembled> assemble_fusions(const graph::FrameGraph& graph,
                                                 const graph::CompiledGraph& compiled, int divide_at);
    std::map<int, Assembled> assemble_others(const graph::FrameGraph& graph,
                                             const std::vector<FusedAssembled>& fusions) const;
    Form with_loads(const graph::FrameGraph& graph, const graph::Pass& pass, ProgramSources sources,
                    int first_unit) const;
    std::optional<ProgramSources> in_compute(const graph::FrameGraph& graph, const graph::Pass& pass,
                                             const ProgramSources& sources, const ShaderContext* shader,
                                             std::string& why_not) const;
    void assemble_forms(const graph::FrameGraph& graph, const graph::Pass& pass, ProgramSources sources,
                        const ShaderContext* shader, Assembled& texts) const;
    std::shared_ptr<const gpu::Program> compute_program(Assembled& texts) const;
    void compile_ahead(const graph::FrameGraph& graph, const std::vector<FusedAssembled>& fusions,
                       const std::map<int, Assembled>& others);
    void fuse(graph::FrameGraph& graph, FusedAssembled& fused, std::vector<BlockBinding>& blocks);
    int blocks_of(const graph::FrameGraph& graph, int pass);
    int count_blocks(const graph::FrameGraph& graph, int pass);
    const std::vector<int>& unused_blocks_of(int pass);
    WorkStatus compiling(const Added& added, const std::string& pass) const;

    Tools tools_;
    ShaderTexts texts_;                       // of all passes
    std::map<int, Added> added_;              // by pass
    std::vector<int> needed_;                 // passes, in order; after finish()
    std::map<int, std::vector<int>> unused_;  // uniform blocks, by pass
    std::map<int, int> block_counts_;         // likewise
    std::unique_ptr<CompileAhead> ahead_;
};

}  // namespace aftershade
