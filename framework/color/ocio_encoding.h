// The encoding of a config's spaces, found by what the config makes of a few numbers. Empty where OpenColorIO
// is absent.
#pragma once

#ifdef AFTERSHADE_HAS_OPENCOLORIO
#include <optional>
#include <string>

#include "framework/color/ocio_config.h"
#include "framework/image/color_encoding.h"

namespace aftershade {

/// The encoding of a space, if the config converts it to ACES2065-1 (a display: to CIE XYZ) by a curve of
/// ColorEncoding and a matrix. nullopt for other spaces, such as logarithmic ones, and if the config has no
/// such conversion. It is measured, not read from names. Throws ocio::Exception.
std::optional<ColorEncoding> encoding_of_space(const OcioConfig& config, const std::string& space);

/// The encoding of what the request makes: that of the display's space, or of the destination.
std::optional<ColorEncoding> encoding_of_result(const OcioConfig& config, const ColorRequest& request);

}  // namespace aftershade
#endif
