// What a manifest must satisfy beyond the types of its fields.
#pragma once

#include "framework/effect/manifest.h"

namespace aftershade {

void check_manifest(const EffectManifest& manifest, const Node& node, Diagnostics& diagnostics);

}  // namespace aftershade
