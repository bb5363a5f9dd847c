// A frame graph in GL memory, with the way back from its parts to the pipeline's.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "framework/graph/executor.h"
#include "framework/pipeline/graph_builder.h"

namespace aftershade {

struct BuiltGraph {
    std::string key;
    std::map<ImportKey, graph::TextureHandle> imports;
    std::map<int, graph::TextureHandle> mask_files;       ///< by step
    std::vector<GraphBuilder::Textures> textures;         ///< per step: textures and outputs, by name
    std::map<std::string, graph::TextureHandle> results;  ///< by role
    std::vector<BoundPass> passes;
    std::vector<BoundParam> params;
    std::vector<ParamValue> uploaded;  ///< of each of `params`
    bool masks_uploaded = false;
    std::map<int, std::map<std::string, graph::TextureHandle>> native_tables;  ///< by step and name
    int first_single_pass = 0;  ///< passes before it run for every sub-frame, the others once a frame
    std::unique_ptr<graph::Executor> executor;
};

/// What decides the graph's form: the size, the images present, and each value that chooses passes, programs
/// or sizes.
std::string graph_key(const Pipeline& pipeline, const FrameInputs& frame, const std::vector<ParamSet>& params,
                      const std::vector<std::string>& roles);

/// `telemetry`: keeps the textures of the steps' statistics. Throws Error(ExitCode::effect);
/// Error(ExitCode::usage) for a tap that no pass writes.
std::unique_ptr<BuiltGraph> build_graph(gpu::Context& context, ProgramCache& programs, StepFiles& files,
                                        const NativeSteps& natives, const Pipeline& pipeline,
                                        const FrameInputs& frame, const std::vector<ParamSet>& params,
                                        const std::vector<std::string>& roles, bool telemetry);

/// The textures of a statistic; without value where no pass writes one of them with the step's parameters.
struct StatisticTextures {
    graph::TextureHandle of;
    std::optional<graph::TextureHandle> where;
};
std::optional<StatisticTextures> find_textures(const GraphBuilder::Textures& textures,
                                               const TelemetrySpec& spec);

}  // namespace aftershade
