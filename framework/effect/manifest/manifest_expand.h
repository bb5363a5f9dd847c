// Groups and loops of a manifest, written out for all later stages. Internal to framework/effect.
#pragma once

#include <filesystem>

#include "framework/base/diagnostics.h"
#include "framework/effect/manifest/manifest.h"

namespace aftershade {

/// Gives each tile list that a pass runs over its buffers and its pass, gives passes without `reads` or
/// `writes` those that their shaders' text names, and hands the conditions of tile lists and textures to what
/// uses them. Names that are not declared stay as they are: check_manifest() reports them. False where the
/// text of a pass's shaders does not say what it uses, which is then reported.
bool write_out(EffectManifest& manifest, const std::filesystem::path& glsl_folder, Diagnostics& diagnostics);

/// The part of write_out() that reads shaders (infer_uses.cpp). All of the reads then stand in the order of
/// the manifest's inputs and after them its textures, all of the writes in that of its outputs and textures.
bool infer_uses(EffectManifest& manifest, const std::filesystem::path& glsl_folder, Diagnostics& diagnostics);

/// Whether each of its passes reads only its own pixel.
bool is_pointwise(const EffectManifest& manifest);
/// EffectManifest::counts_from_part.
bool counts_from_part(const EffectManifest& manifest, const std::filesystem::path& glsl_folder);

}  // namespace aftershade
