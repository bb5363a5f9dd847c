// How far two images are apart.
#pragma once

#include "framework/image/image.h"

namespace aftershade {

/// The PSNR of docs/measures.md: both images clamped to [0, 1], encoded by the piecewise sRGB curve
/// in double precision without an 8-bit step, mean squared error over all pixels and R, G, B, peak 1.
double display_psnr_db(const Image& reference, const Image& test);

/// The piecewise sRGB curve of a value clamped to [0, 1]; NaN becomes 0.
double srgb_of_clamped(double linear);

}  // namespace aftershade
