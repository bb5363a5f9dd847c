// Rules of a manifest beyond the types of its fields. Internal to framework/effect.
#pragma once

#include <string>

#include "framework/effect/manifest/manifest.h"

namespace aftershade {

void check_manifest(const EffectManifest& manifest, Diagnostics& diagnostics);

/// That no name is a word of GLSL or of the host, and that no two things have one name in GLSL.
void check_names(const EffectManifest& manifest, Diagnostics& diagnostics);

/// Whether no GLSL identifier may have the name, and whether a global one would hide what shaders need.
bool is_glsl_word(const std::string& name);
bool hides_glsl(const std::string& name);

/// Each pass by itself, and in order: who reads what before it is written.
void check_passes(const EffectManifest& manifest, Diagnostics& diagnostics);

/// Each tile list, and that each pass over tiles names one and writes what they can lie on.
void check_tiles(const EffectManifest& manifest, Diagnostics& diagnostics);

/// "pass 'x'", "tile list 'x' of the module 'lens' in 'dof'": what faults of a pass begin with.
std::string label_of(const EffectManifest& manifest, const PassSpec& pass);

}  // namespace aftershade
