// A fragment shader over a target as a compute shader that stores its texels: GPUs of data centres draw with
// a few of their multiprocessors and compute with all (docs/gpu.md).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/effect/shader_source.h"
#include "framework/gpu/texture_format.h"

namespace aftershade {

/// The images that a compute shader may have: GL has at least as many (OpenGL 4.5 core, table 23.71).
inline constexpr int kMostComputeImages = 8;

/// Inputs that a draw gives to its shader without a declaration in the shader's text.
struct DrawShape {
    std::vector<gpu::TextureFormat> targets;  ///< by location
    int first_target_unit = 0;                ///< image units of the targets, which rise from it
    bool has_levels = false;                  ///< some sampler sees several levels of its texture
    /// Name of the buffer of rectangles, for a pass over tiles. The block of glsl/host/tiles.vert is bound.
    std::optional<std::string> tile_runs{};
};

/// Makes of `source`, which draws, a compute shader for gpu::dispatch_over(): gl_FragCoord becomes a
/// variable, the outputs too, which are stored once main() has ended, unless that discarded the pixel. Keeps
/// the lines. Returns the reason against it, such as "reads gl_FrontFacing", or "". The driver may still
/// refuse the text.
std::string to_compute_form(ShaderSource& source, const DrawShape& shape);

}  // namespace aftershade
