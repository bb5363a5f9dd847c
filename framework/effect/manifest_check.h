// What a manifest must satisfy beyond the types of its fields. Internal to framework/effect.
#pragma once

#include "framework/effect/manifest.h"

namespace aftershade {

void check_manifest(const EffectManifest& manifest, const Node& node, Diagnostics& diagnostics);

/// That no name is a word of GLSL or of the host, and that no two things have one name in GLSL.
void check_names(const EffectManifest& manifest, Diagnostics& diagnostics);

/// Each pass by itself, and in order: who reads what before it is written.
void check_passes(const EffectManifest& manifest, Diagnostics& diagnostics);

}  // namespace aftershade
