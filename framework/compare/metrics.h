// How far two images are apart.
#pragma once

#include "framework/image/image.h"

namespace aftershade {

/// Where and by how much two images differ most.
struct MaxDifference {
    double value =
        0;  ///< absolute; +inf where exactly one of the two is NaN or they are infinities of other signs
    int x = 0;
    int y = 0;
    int channel = 0;
};

struct ImageMetrics {
    double mean_absolute = 0;
    double rmse = 0;
    double psnr_db = 0;  ///< peak 1; +inf for equal images
    MaxDifference max;
};

/// Over the first `channels` channels of both, as they are stored. The two must have one size and at least
/// that many channels (asserted: callers report sizes that differ). NaN equals NaN and an infinity itself
/// only with `nan_equal`; otherwise they make every figure infinite, and PSNR minus infinity.
ImageMetrics compare_images(const Image& reference, const Image& test, int channels, bool nan_equal = false);

/// The PSNR of docs/measures.md: both images clamped to [0, 1], encoded by the piecewise sRGB curve
/// in double precision without an 8-bit step, mean squared error over all pixels and R, G, B, peak 1.
double display_psnr_db(const Image& reference, const Image& test);

/// The piecewise sRGB curve of a value clamped to [0, 1]; NaN becomes 0.
double srgb_of_clamped(double linear);

}  // namespace aftershade
