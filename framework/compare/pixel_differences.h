// How far the pixels of two layers are apart: figures, places, counts.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "framework/compare/difference_rules.h"
#include "framework/compare/layer.h"
#include "framework/image/image.h"

namespace aftershade {

struct PixelAreas;

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

/// Figures of the pixels that are not left out. Means run over the values that are finite in both images
/// (`values` of them), in double precision. Only the counts of LimitCounts forgive.
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
