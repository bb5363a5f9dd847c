// The source of an input in a look's "in": a role of the capture, or an output or a texture of an earlier
// step.
#pragma once

#include <optional>

#include "framework/base/diagnostics.h"
#include "framework/effect/manifest/manifest.h"
#include "framework/look/pipeline.h"

namespace aftershade {

/// Where `input` of an effect takes its image from, as `wiring` says; `maker` is the earlier step that it
/// names, `index` in the pipeline, or nullptr and -1 for the capture.
///
/// An input of a role aov:<name> takes any image of floats: any role, output or texture, a texture in its own
/// size. An input of another role takes that role, or a texture that has the working grid's size, the role's
/// kind of numbers and at least its channels. A texture with levels gives level 0. Names of outputs come
/// before those of textures. nullopt where it does not fit, which `diagnostics` then reports.
std::optional<InputSource> wired_source(const WiringSpec& wiring, const InputSpec& input,
                                        const EffectManifest& effect, const EffectManifest* maker, int index,
                                        Diagnostics& diagnostics);

}  // namespace aftershade
