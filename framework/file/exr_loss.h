// Which channels a compression of OpenEXR stores with loss.
#pragma once

#include <string_view>

#include "framework/image/pixel_type.h"

namespace aftershade {

/// Whether the compression may change values of a channel of this name and type. dwaa and dwab do in channels
/// whose last component is R, G, B, Y, RY or BY, of half and float; lj2k in R, G and B of any case; b44 and
/// b44a in half; pxr24 in float. Integers stay.
bool loses_bits(std::string_view compression, std::string_view channel, PixelType type);

}  // namespace aftershade
