// A frame graph in GL memory, with what it must be given for each frame and where its results lie.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/effect/manifest/manifest.h"
#include "framework/graph/executor.h"
#include "framework/render/compile_ahead.h"
#include "framework/render/graph_bindings.h"
#include "framework/render/graph_key.h"

namespace aftershade {

/// Textures and outputs of a step by name, as they are after its last pass.
using StepTextures = std::map<std::string, graph::TextureHandle>;

/// Made by build_graph().
struct BuiltGraph {
    GraphKey key;
    std::vector<GraphBinding> bindings;
    std::vector<StepTextures> textures;                   ///< by step
    std::map<std::string, graph::TextureHandle> results;  ///< by role
    std::map<std::string, graph::TextureHandle> taps;     ///< by "step.texture"
    std::vector<int> first_pass_of_step;  ///< its index in the graph; the next step's where it has no pass
    int first_single_pass = 0;  ///< passes before it run for every sub-frame, the others once a frame
    std::unique_ptr<CompileAhead> ahead;  ///< for the first run; nullptr where nothing needs it
    std::unique_ptr<graph::Executor> executor;

    /// Gives the graph all that the passes from feed.first_pass on need of a frame. Throws what give()
    /// throws.
    void feed(const GraphFeed& feed) {
        for (GraphBinding& binding : bindings) give(binding, feed, *executor);
    }
};

/// The textures of a statistic; without value where no pass writes one of them with the step's parameters.
struct StatisticTextures {
    graph::TextureHandle of;
    std::optional<graph::TextureHandle> where;
};
inline std::optional<StatisticTextures> find_textures(const StepTextures& textures,
                                                      const TelemetrySpec& spec) {
    StatisticTextures found{textures.at(spec.of.texture), std::nullopt};
    if (spec.where) found.where = textures.at(spec.where->texture);
    if (found.of.version == 0 || (found.where && found.where->version == 0)) return std::nullopt;
    return found;
}

}  // namespace aftershade
