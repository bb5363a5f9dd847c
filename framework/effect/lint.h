// Warnings about manifests and shaders that are allowed and likely wrong.
#pragma once

#include <filesystem>

#include "framework/base/diagnostics.h"
#include "framework/effect/manifest/manifest.h"

namespace aftershade {

/// Warnings with their places: a texture that no output depends on, half or 8-bit formats for what is written
/// from depth, velocity, positions or ids alone, history whose shaders never test frame.history_valid, an
/// sRGB encoding in an effect that makes no display, loops bounded by a parameter in a pass without
/// "max_iterations".
void lint_effect(const EffectManifest& manifest, const std::filesystem::path& glsl_folder,
                 Diagnostics& diagnostics);

}  // namespace aftershade
