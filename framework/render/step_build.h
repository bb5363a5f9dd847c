// The state of one step while GraphBuilder adds its passes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "framework/effect/param_reader.h"
#include "framework/graph/frame_graph.h"
#include "framework/look/pipeline.h"

namespace aftershade {

struct StepBuild {
    using Textures = std::map<std::string, graph::TextureHandle>;
    using Buffers = std::map<std::string, graph::BufferHandle>;

    int index = 0;
    const PipelineStep& step;
    ParamReader params;
    std::vector<std::string> present;  ///< inputs that have an image
    Textures inputs{};                 ///< by input
    Textures textures{};               ///< textures and outputs: the live versions
    Textures previous{};               ///< of textures and inputs with history
    Textures history_current{};        ///< where the next frame finds them
    Textures param_textures{};         ///< curves and files
    Textures native_tables{};
    Buffers buffers{};
    Buffers previous_buffers{};
    Buffers param_buffers{};  ///< tables

    const EffectManifest& manifest() const { return *step.manifest; }
    std::string prefix() const { return step.name + "."; }
    /// The image of `reads: ["color"]`: the input of that name, else the texture.
    graph::TextureHandle read_handle(const std::string& name) const {
        const auto input = inputs.find(name);
        return input != inputs.end() ? input->second : textures.at(name);
    }
};

}  // namespace aftershade
