// Compiles the shader of a pass and speaks of its faults in the author's files and lines.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "framework/effect/shader_source.h"
#include "framework/gpu/program.h"

namespace aftershade {

/// Programs by their full text, so that equal shaders compile once. [the context's thread]
class ProgramCache {
public:
    ProgramCache(gpu::Context& context, std::filesystem::path glsl_folder);

    /// Throws Error(ExitCode::effect) with one line per fault:
    /// "effects/bokeh/coc.frag:6:17: error: 'parm' undeclared   [pass coc, llvmpipe ...]".
    const gpu::Program& get(const ShaderContext& context);
    const std::filesystem::path& glsl_folder() const { return glsl_folder_; }

private:
    gpu::Context& context_;
    std::filesystem::path glsl_folder_;
    std::string vertex_;
    std::map<std::string, gpu::Program> programs_;
};

}  // namespace aftershade
