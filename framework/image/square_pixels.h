// A grid of pixels that are not square, and the grid of square pixels that stands for it.
#pragma once

#include <cstdint>

#include "framework/image/image.h"

namespace aftershade {

/// Pixels are stretched along the axis on which they are long: `to` square ones stand for `from` of them.
/// Pixel p of the display window, counted from its corner, becomes the pixels edge(p) to edge(p + 1) - 1, at
/// least one: the same ones in any data window.
struct PixelStretch {
    int axis = 0;  ///< 0: x, 1: y
    std::int64_t to = 1;
    std::int64_t from = 1;

    bool is_none() const { return to == from; }
    /// The factor from stored to square pixels for a length along x (0) or y (1).
    double scale(int along) const { return along == axis ? double(to) / double(from) : 1; }
    std::int64_t edge(std::int64_t px) const;
    /// `px` modulo `from`: where among the pixels that are stretched alike a window begins.
    std::int64_t phase(std::int64_t px) const { return (px % from + from) % from; }
    bool operator==(const PixelStretch&) const = default;
};

/// By the fraction of least denominator within 1/2000 of the aspect, so that 1.3333 is 4/3. No stretch where
/// the aspect is not a positive number.
PixelStretch square_pixels(float pixel_aspect);

/// A window of pixels as one of square pixels, in the coordinates of a display window with the same corner. A
/// side beyond an int ends there.
Window stretched(const Window& window, const Window& display, const PixelStretch& stretch);

}  // namespace aftershade
