// Parameters of which OpenColorIO makes a transform: a file, and words for it.
#pragma once

#include <functional>
#include <optional>

#include "framework/base/diagnostics.h"
#include "framework/color/color_transform.h"
#include "framework/document/param.h"
#include "framework/effect/manifest/manifest.h"

namespace aftershade {

/// One for the file parameter, in which nothing is said.
ColorRequest empty_request(const ParamSpec& file);
/// Whether a value of the parameter is a part of its effect's request: the file, or what has an `ocio`.
bool is_color_part(const ParamSpec& spec);
/// Puts a value of such a parameter into the request.
void set_color_part(ColorRequest& request, const ParamSpec& spec, const ParamValue& value);

/// The request of a parameter with is_ocio_file(), with the effect's values; nullopt where its file is a
/// transform and none is given.
std::optional<ColorRequest> color_request(const EffectManifest& manifest, const ParamSpec& file,
                                          const std::function<ParamValue(const ParamSpec&)>& value);

/// The parameter whose value is at fault: that of the part, else the file's.
const ParamSpec& param_at_fault(const EffectManifest& manifest, const ParamSpec& file,
                                const ColorFault& fault);

}  // namespace aftershade
