// Pixels that are not numbers: counted, and replaced on request.
#pragma once

#include <cstddef>
#include <span>

#include "framework/image/image.h"

namespace aftershade {

/// NaN and infinities of one image, by pixel: a pixel counts once, whichever of its channels is at fault.
struct NonFinitePixels {
    std::size_t nan = 0;       ///< pixels with a NaN
    std::size_t infinite = 0;  ///< pixels with an infinity and no NaN
    int x = 0;                 ///< of the first, by rows from the top left of the image
    int y = 0;
    std::size_t mended = 0;  ///< of these, pixels that mend_non_finite() replaced
    std::size_t zeroed = 0;  ///< of the repaired ones: no finite neighbour, so 0

    std::size_t count() const { return nan + infinite; }
    explicit operator bool() const { return count() > 0; }
};

/// `infinity_allowed` is for depth, where +inf means that nothing was hit; -inf is never right. An image of
/// integers has no such pixels. A sound image costs one read of its memory.
/// `threads` may look at a time.
NonFinitePixels find_non_finite(const Image& image, bool infinity_allowed, int threads = 1);

/// Whether none of them is NaN or infinite.
bool are_finite(std::span<const float> values);

/// Half the side of the largest neighbourhood that mend_non_finite() looks at, px.
inline constexpr int kMendRadius_px = 3;

/// Replaces each value at fault by the mean of its channel's finite values in the 3 x 3 pixels around it,
/// else in the 5 x 5, else in the 7 x 7, else by 0. Means are of values as they were, so no order matters.
/// Other values keep their bits.
NonFinitePixels mend_non_finite(Image& image, bool infinity_allowed, int threads = 1);

}  // namespace aftershade
