// The encoding of an sRGB display; its twin for shaders is glsl/srgb.glsl.
#pragma once

#include <cmath>

namespace aftershade {

/// The piecewise curve of IEC 61966-2-1. Values below 0 follow its straight part, values above 1 its power.
inline double encode_srgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

/// Its inverse. Values below 0 follow its straight part, values above 1 its power.
inline double decode_srgb(double encoded) {
    return encoded <= 12.92 * 0.0031308 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace aftershade
