// From steps and their parameters to the passes of a frame graph.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "framework/effect/pass_program.h"
#include "framework/graph/frame_graph.h"
#include "framework/image/capture.h"
#include "framework/pipeline/pipeline.h"

namespace aftershade {

/// The uniform block `frame` of one step.
std::vector<std::byte> frame_block(const CaptureHeader& header, const std::string& step);

/// Adds the passes of one step after the other to a graph.
class GraphBuilder {
public:
    using Names = std::map<std::string, graph::TextureHandle>;

    GraphBuilder(ProgramCache& programs, const Pipeline& pipeline, const Capture& capture);

    /// Calls `bound` with the index in the graph of each pass that runs; returns the step's textures and
    /// outputs by name. Throws Error(ExitCode::effect) where a pass reads, or the step outputs, what no pass
    /// has written with these parameters.
    Names add_step(int index, const ParamSet& params, const std::vector<Names>& earlier,
                   const std::function<void(int pass)>& bound);

    graph::FrameGraph graph;
    Names imports;  ///< by role

private:
    graph::TextureHandle import(const std::string& role);
    void add_pass(const PipelineStep& step, const ShaderContext& shader, const Names& inputs, Names& names);

    ProgramCache& programs_;
    const Pipeline& pipeline_;
    const Capture& capture_;
    std::vector<std::string> roles_;
    int width_ = 0;
    int height_ = 0;
};

}  // namespace aftershade
