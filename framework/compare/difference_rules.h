// When a pixel counts as failing.
#pragma once

#include <limits>

namespace aftershade {

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

}  // namespace aftershade
