// The limits of a layer, or of an area of it.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "framework/compare/pixel_differences.h"

namespace aftershade {

/// A level is exceeded where more than `percent` of a layer's pixels, and more than `allowed` pixels, differ
/// by more than `limit`; or more than `allowed` by more than `hard`. Both are always tested (idiff
/// does not test -hardfail and -warn if no pixel exceeds -fail).
struct Tolerance {
    double limit = 1e-6;  ///< of a pixel's difference; see DifferenceRules
    double percent = 0;   ///< of the pixels
    double hard = std::numeric_limits<double>::infinity();
    std::uint64_t allowed = 0;  ///< pixels
    /// A difference above `limit` counts where it is also more than this part of its magnitude; see
    /// DifferenceRules. `hard` does not ask it.
    double relative = 0;
    double ulp = 0;  ///< units in the last place by which pixels may differ; see DifferenceRules
};

struct Levels {
    Tolerance fail;
    /// nullopt: as `fail`, but with percent 0, so that what only `percent` lets pass is a warning, as
    /// idiff's.
    std::optional<Tolerance> warn;
    std::optional<double> fail_flip, warn_flip;  ///< exceeded by the mean of a layer's FLIP, LDR or HDR
    std::optional<double> fail_ssim, warn_ssim;  ///< exceeded where a layer's SSIM is below

    Tolerance warn_tolerance() const;
    /// Whether some difference of a layer of this role and number of pixels exceeds a level of fail or warn;
    /// NaN against a number exceeds any level. FLIP and SSIM count if the layer has them.
    bool judge(LayerRole role, std::uint64_t pixels, bool has_flip, bool has_ssim) const;
    /// The limits of a pixel alone.
    DifferenceRules difference_limits() const;
};

}  // namespace aftershade
