// Several passes as one program: each computes its pixel, hands it to the next, and the last results alone
// are written.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/effect/shader_source.h"

namespace aftershade {

/// What keeps a shader out of a fused program: a pixel that it may leave as it was, an extension, a global
/// name of GLSL's components. "" where nothing does.
std::string fault_of_fusing(const ShaderContext& shader);

/// The uniform blocks that a fused shader need not have, by their bindings: its text names none of their
/// members. GL bounds their number and counts those that nothing uses, too.
std::vector<int> unused_blocks(const ShaderContext& shader);

/// GL has at least this many uniform blocks, samplers and storage blocks for a fragment shader (OpenGL 4.5
/// core, tables 23.60 and 23.66).
inline constexpr int kMaxFusedBlocks = 14;
inline constexpr int kMaxFusedSamplers = 16;
inline constexpr int kMaxFusedBuffers = 8;
inline constexpr int kMaxFusedParts = 8;
/// Uniform blocks of part n begin at the binding n times this.
inline constexpr int kBlocksPerPart = 8;

/// A read by the pixel of what an earlier part writes.
struct HeldRead {
    std::string read;  ///< its name in GLSL
    int part = 0;
    std::string write;
};
struct FusedShader {
    ShaderContext shader;  ///< its `part` is FusedProgram's own
    FusedPart part;
    std::vector<HeldRead> held;
};
/// A result that is written to memory.
struct FusedTarget {
    int part = 0;
    std::string write;
};
struct FusedProgram {
    std::vector<FusedShader> parts;
    std::vector<FusedTarget> targets;  ///< by location
};

/// The text of the program, with the authors' lines. Every global name of a part gets the part's own prefix,
/// by the preprocessor. Faults of the parts' own assembly go to `diagnostics`.
ShaderSource assemble_fused(const FusedProgram& program, Diagnostics& diagnostics);

}  // namespace aftershade
