// What the user's OpenColorIO config has for the parameters of an effect that takes one.
#pragma once

#include <optional>
#include <string>

#include "framework/base/diagnostics.h"
#include "framework/color/color_transform.h"
#include "framework/effect/manifest/manifest.h"

namespace aftershade::cli {

/// nullopt for effects without such a parameter, and where the config cannot be read, of which it warns.
std::optional<ColorNames> ocio_names(const EffectManifest& manifest, Diagnostics& diagnostics);

/// "" without names.
std::string ocio_names_text(const std::optional<ColorNames>& names);
/// The description with a member "ocio".
std::string with_ocio_names(const std::string& description, const std::optional<ColorNames>& names);

}  // namespace aftershade::cli
