// Which pixels count, and when one counts as failing.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace aftershade {

/// Differences that a comparison forgives; at most one of the two. Forgiveness (forgiveness.h) defines both.
struct Forgive {
    static constexpr int kMaxShift_px = 64;
    static constexpr double kMaxBlur_px = 32;

    int shift_px = 0;    ///< 0 to kMaxShift_px
    double blur_px = 0;  ///< standard deviation, 0 to kMaxBlur_px
    bool any() const { return shift_px > 0 || blur_px > 0; }
    bool operator==(const Forgive&) const = default;
};

/// How finely a file stores the values of a layer: floats with a number of bits, or steps of one size.
struct StoredPrecision {
    int mantissa_bits = 23;
    int least_exponent = -126;  ///< of normal numbers
    double step = 0;            ///< of integers that stand for 0 to 1; 0: they are floats

    /// The unit in the last place at a magnitude, which is at least 0.
    double unit_at(double magnitude) const {
        if (step > 0) return step;
        const bool is_normal = magnitude > 0 && std::isfinite(magnitude);
        return std::ldexp(1.0, std::max(is_normal ? std::ilogb(magnitude) : least_exponent, least_exponent) -
                                   mantissa_bits);
    }
    /// Which of both is coarser.
    StoredPrecision coarser(const StoredPrecision& other) const {
        return unit_at(1) < other.unit_at(1) ? other : *this;
    }
};
inline constexpr StoredPrecision kStoredHalf{10, -14, 0};

/// When a pixel counts as failing. A pixel's difference is, by role:
///   color, display, alpha, data   the largest |reference - test| of its channels;
///   depth       |reference - test| / |reference|: infinity equals infinity of its sign, 0 equals 0;
///   velocity    the end-point error in px: the length of the difference of the vectors; four
///               channels are two vectors (X Y, Z W), of which the larger error counts;
///   id          0 where all bits are equal, else infinite.
/// Where a channel is NaN in one image or (without `nan_equal`) in both, or infinite in one or with another
/// sign, the pixel's difference is infinite and the pixel fails at any limit.
///
/// `fail_relative` R lets rounding of a large value pass. For color, display, alpha and data, a channel
/// counts if |reference - test| > R (|reference| + |test|) / 2; for velocity a vector counts, by lengths.
/// Depth is relative already. It holds for `fail`, not for `hard_fail`, as idiff's -failrelative.
///
/// `fail_ulp` N lets a difference pass, for `fail` and `hard_fail`, that is at most N units in the last place
/// of the coarser file's type, at the larger of both magnitudes. The lengths of its vectors
/// count for velocity.
struct DifferenceRules {
    double fail = 1e-6;  ///< a pixel fails above it
    double hard_fail = std::numeric_limits<double>::infinity();
    double warn = 1e-6;
    double hard_warn = std::numeric_limits<double>::infinity();
    bool nan_equal = false;
    Forgive forgive;  ///< of a layer; areas have their layer's
    double fail_relative = 0, warn_relative = 0;
    double fail_ulp = 0, warn_ulp = 0;
    StoredPrecision stored;  ///< of a layer; areas have their layer's
};

/// The limits of each pixel of an image, row by row: 0 the layer's limits, kLeftOut none, i the limits
/// limits[i - 1] of an area. Empty: the layer's limits for every pixel. [value type]
struct PixelAreas {
    static constexpr std::uint8_t kLeftOut = 255;
    static constexpr std::size_t kMost = 254;  ///< areas with limits of their own

    std::vector<std::uint8_t> of_pixel;
    std::vector<DifferenceRules> limits;

    std::uint8_t at(int x, int y, int width) const {
        return of_pixel.empty() ? 0 : of_pixel[std::size_t(y) * std::size_t(width) + std::size_t(x)];
    }
    bool is_left_out(int x, int y, int width) const { return at(x, y, width) == kLeftOut; }
};

}  // namespace aftershade
