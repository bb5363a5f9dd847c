// Whether an effect does what every effect must: compiles in all its forms, and stays finite.
#pragma once

#include <filesystem>

#include "framework/base/diagnostics.h"
#include "framework/effect/manifest/manifest.h"
#include "framework/gpu/context.h"
#include "framework/render/native_steps.h"

namespace aftershade {

/// Renders the effect over the test capture with every value of its bools, enums and define-bound ints, one
/// at a time from the defaults; with numbers at min and max; with and without each optional input. Shaders
/// that do not compile and values that are not finite (but infinite depth) are errors, each with the setting
/// that brought it. [the context's thread]
void check_effect(gpu::Context& context, const EffectManifest& manifest,
                  const std::filesystem::path& data_folder, NativeSources natives, Diagnostics& diagnostics);

}  // namespace aftershade
