// From an effect's shader file to the text that GL compiles, with a table back to the author's lines.
//
// A shader begins `#version 450 core` and `#include <pass>`. The host generates what <pass> stands for: a
// sampler and
// `<name>_size` = vec4(w, h, 1/w, 1/h) per read, `out_<name>` per write, and the blocks `param` and `frame`
// (docs/shaders.md). `#include <x.glsl>` takes a module of glsl/, `#include "x.glsl"` one of the effect's
// folder; each is included once.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "framework/core/diagnostics.h"
#include "framework/core/param.h"
#include "framework/effect/manifest.h"

namespace aftershade {

/// Bindings of the generated uniform blocks.
inline constexpr int kParamBinding = 0;
inline constexpr int kFrameBinding = 1;
inline constexpr int kSizeBinding = 2;

/// What one pass sees, resolved for one set of parameters and inputs.
struct ShaderContext {
    const EffectManifest* manifest = nullptr;
    const PassSpec* pass = nullptr;
    const ParamSet* params = nullptr;         ///< define-bound values become preprocessor symbols
    std::vector<std::string> present_inputs;  ///< optional inputs that the frame has
    std::filesystem::path glsl_folder;
};

struct SourceLine {
    std::string file;  ///< "<generated>" for the host's own lines
    int line = 0;
};

struct ShaderSource {
    std::string text;
    std::vector<SourceLine> lines;  ///< of text, from its first
};

/// Faults (a missing include, a shader that does not begin as it must) go to `diagnostics`.
ShaderSource assemble_shader(const ShaderContext& context, Diagnostics& diagnostics);

/// The reads of a pass that are there: inputs that are present, and textures. Their order gives the sampler
/// bindings.
std::vector<ReadSpec> present_reads(const EffectManifest& manifest, const PassSpec& pass,
                                    const std::vector<std::string>& present_inputs);

/// Whether every condition of the pass holds.
bool pass_enabled(const PassSpec& pass, const ParamSet& params,
                  const std::vector<std::string>& present_inputs);

/// Format of an input's or output's texture: its role's channels as floats, or unsigned integers.
gpu::TextureFormat texture_format_of_role(const std::string& role);

/// The block `param` in std140, in the manifest's order: every parameter that is bound as a uniform.
std::vector<std::byte> param_block(const EffectManifest& manifest, const ParamSet& params);
bool has_param_block(const EffectManifest& manifest);

/// The block `frame`; the same for every pass of a frame but for `step_seed`.
struct FrameBlock {
    std::int32_t display_size_px[2] = {0, 0};  ///< of the display window
    std::int32_t origin_px[2] = {0, 0};        ///< display-window pixel of texel (0, 0)
    std::int32_t number = 0;                   ///< of the frame
    std::uint32_t step_seed = 0;               ///< differs between the steps of a look
    std::int32_t padding[2] = {0, 0};          ///< std140 begins a matrix at 16 bytes
    float rec709_from_color[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};  ///< by columns, each a vec4
};
std::string_view frame_block_glsl();

}  // namespace aftershade
