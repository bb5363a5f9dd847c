// Compares a manifest's declarations with the use in its shaders, by their text; needs no GL.
#pragma once

#include <filesystem>

#include "framework/base/diagnostics.h"
#include "framework/effect/manifest/manifest.h"

namespace aftershade {

/// Every uniform parameter, define parameter, read, image, buffer, native value and output is used, and every
/// `param.x`, `native.x` and `out_x` that is used is declared. Reads, images, buffers and outputs count per
/// pass; a parameter also counts as used where a condition, a size or a count of the manifest takes it, and
/// an effect with native code may leave parameters to it. The predicate of a tile list has its function.
/// Comments do not count; all branches of #if do.
/// Faults are errors at the shader's line or the manifest's place, each once.
void check_declared_used(const EffectManifest& manifest, const std::filesystem::path& glsl_folder,
                         Diagnostics& diagnostics);

}  // namespace aftershade
