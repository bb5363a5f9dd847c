// How far the pixels of two layers are apart: figures, places, counts.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "framework/compare/layer.h"
#include "framework/image/image.h"

namespace aftershade {

struct PixelAreas;

/// What differences a comparison forgives; at most one of the two. Forgiveness (forgiveness.h) defines both.
struct Forgive {
    static constexpr int kMaxShift_px = 64;
    static constexpr double kMaxBlur_px = 32;

    int shift_px = 0;    ///< 0 to kMaxShift_px
    double blur_px = 0;  ///< standard deviation, 0 to kMaxBlur_px
    bool any() const { return shift_px > 0 || blur_px > 0; }
    bool operator==(const Forgive&) const = default;
};

/// When a pixel counts as failing. A pixel's difference is, by role:
///   color, display, alpha, data   the largest |reference - test| of its channels;
///   depth       |reference - test| / |reference|: infinity equals infinity of its sign, 0 equals 0;
///   velocity    the end-point error in px: the length of the difference of the vectors; four channels are
///   two
///               vectors (X Y, Z W), of which the worse counts;
///   id          0 where all bits are equal, else infinite.
/// Where a channel is NaN in one image or (without `nan_equal`) in both, or infinite in one or with another
/// sign, the pixel's difference is infinite and the pixel fails whatever the limit.
///
/// `fail_relative` R lets differences pass that are in the last digits of a large value: of color, display,
/// alpha and data a channel counts where |reference - test| > R (|reference| + |test|) / 2, of velocity a
/// vector, by lengths. Depth is relative already. It holds for `fail`, not for `hard_fail`, as idiff's
/// -failrelative.
struct DifferenceRules {
    double fail = 1e-6;  ///< a pixel fails above it
    double hard_fail = std::numeric_limits<double>::infinity();
    double warn = 1e-6;
    double hard_warn = std::numeric_limits<double>::infinity();
    bool nan_equal = false;
    Forgive forgive;  ///< of a layer; areas have their layer's
    double fail_relative = 0, warn_relative = 0;
};

/// The pixel and channel of the largest |reference - test|; of ids the first that differ.
struct LargestDifference {
    double value = 0;  ///< +inf where the values cannot be subtracted
    int x = 0, y = 0;  ///< from the upper left pixel of the images
    int channel = 0;
    double reference = 0, test = 0;  ///< the stored values there
};

/// Pixels above a limit, and the smallest window around them, from the images' upper left pixel.
struct FailingPixels {
    std::uint64_t count = 0;
    Window box;  ///< empty (width 0) where there are none
};

/// Pixels under one set of limits, and those of them above each.
struct LimitCounts {
    std::uint64_t pixels = 0;
    FailingPixels failing, hard_failing, warning, hard_warning;
};

struct NonFiniteCounts {
    std::uint64_t nan = 0, infinite = 0;  ///< values, not pixels
    bool operator==(const NonFiniteCounts&) const = default;
};

/// Constant eps of relMSE = mean((test - reference)^2 / (reference^2 + eps)), which keeps black pixels from
/// ruling it. Relative error: Rousselle et al. 2011, doi:10.1145/2070781.2024193; figures of other papers
/// compare only where their eps is this.
inline constexpr double kRelativeMseEpsilon = 1e-2;

/// Of the pixels that are not left out. Means run over the values that are finite in both images (`values` of
/// them), in double precision. Only the counts of LimitCounts forgive.
struct PixelDifferences : LimitCounts {  ///< its counts: of each pixel by the limits that hold there
    std::uint64_t left_out = 0;          ///< pixels; not among `pixels`
    std::uint64_t forgiven = 0;  ///< pixels whose own difference fails, and that pass because it is forgiven
    std::uint64_t values = 0;
    std::uint64_t incomparable = 0;  ///< values that are not finite in either and not equal under the rules
    LargestDifference largest;
    double mean_absolute = 0;
    double rmse = 0;
    double relative_mse = 0;
    /// 20 log10(peak / rmse), +inf for equal images, NaN where what can be compared is equal and the rest
    /// cannot be. Peak: 1 for display and alpha, else the largest finite
    /// magnitude in the reference (1 where that is 0).
    double psnr_db = std::numeric_limits<double>::infinity();
    double psnr_peak = 1;
    double largest_pixel = 0;          ///< the largest difference of a pixel as DifferenceRules defines it
    double mean_pixel = 0;             ///< over pixels where it is finite; depth: relative; velocity: px
    std::vector<LimitCounts> by_area;  ///< first the pixels in no area, then each area of PixelAreas::limits
    NonFiniteCounts reference_counts, test_counts;
    bool bits_equal = true;  ///< every stored value has the same bits
};

/// Both images must have one size, type and channel count (asserted), and `areas` that many pixels or none.
/// The figures do not depend on `threads`. [thread-safe]
PixelDifferences pixel_differences(const Image& reference, const Image& test, LayerRole role,
                                   const DifferenceRules& rules, const PixelAreas& areas, int threads = 1);
/// Every pixel under `rules`.
PixelDifferences pixel_differences(const Image& reference, const Image& test, LayerRole role,
                                   const DifferenceRules& rules, int threads = 1);

/// The difference of the pixels at (x, y) as DifferenceRules defines it.
double pixel_difference(const Image& reference, const Image& test, int x, int y, LayerRole role,
                        bool nan_equal);

}  // namespace aftershade
