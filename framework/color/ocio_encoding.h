// The encoding of a config's spaces, found by what the config makes of a few numbers. Empty where OpenColorIO
// is absent.
#pragma once

#ifdef AFTERSHADE_HAS_OPENCOLORIO
#include <optional>
#include <string>

#include "framework/color/ocio_config.h"
#include "framework/image/color_encoding.h"

namespace aftershade {

/// Of a space that the config takes to ACES2065-1, or of a display to CIE XYZ, by one of the curves of
/// ColorEncoding and a matrix; nullopt for others, such as logarithms, and where the config says no such way.
/// Names play no part. Throws ocio::Exception.
std::optional<ColorEncoding> encoding_of_space(const OcioConfig& config, const std::string& space);

/// Of what the request makes: of the display's space, or of the destination.
std::optional<ColorEncoding> encoding_of_result(const OcioConfig& config, const ColorRequest& request);

}  // namespace aftershade
#endif
