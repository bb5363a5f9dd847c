// JSON Schema (draft 2020-12) of looks, made from the declarations of the effects that they may use.
//
// What an editor completes and marks is what the program takes and refuses, as far as a schema can say it:
// that names which another document declares (steps, variables) exist, and how two values relate: only the
// program checks that.
#pragma once

#include <string>
#include <vector>

#include "framework/effect/manifest/manifest.h"

namespace aftershade {

/// One branch for each effect, with its parameters, their docs, units and ranges.
std::string look_schema(const std::vector<const EffectManifest*>& effects);

}  // namespace aftershade
