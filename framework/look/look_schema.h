// JSON Schema (draft 2020-12) of looks, made from the declarations of the effects that they may use.
//
// An editor completes and marks the same as the program accepts and refuses, as far as a schema allows. Only
// the program checks that names which another document declares (steps, variables) exist, and how two values
// relate.
#pragma once

#include <string>
#include <vector>

#include "framework/effect/manifest/manifest.h"

namespace aftershade {

/// One branch for each effect, with its parameters, their docs, units and ranges.
std::string look_schema(const std::vector<const EffectManifest*>& effects);

}  // namespace aftershade
