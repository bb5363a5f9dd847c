// Values that a renderer averaged over a pixel's samples. Between two surfaces such a mean is a value that
// neither has: a depth in mid air, a normal that nothing faces.
#pragma once

#include <cstddef>

#include "framework/image/image.h"

namespace aftershade {

/// Puts at every pixel that mixes two surfaces the value of the one that it is nearer to. A pixel is a
/// mixture where, along a row, a column or a diagonal, a smooth surface lies on either side of it, at most
/// three pixels away, and its value is strictly between what the two would have there, with all values on the
/// way rising or falling. The surface's value is continued in a straight line to the pixel. Values that are
/// not finite are left alone, and so is what is thinner than two pixels. Images have one to three channels,
/// as stored, before they are decoded. Returns the number of pixels that changed. [thread-safe]
std::size_t repair_means(Image& image);

/// Edges of a depth, along rows and columns.
struct DepthEdges {
    std::size_t sharp = 0;  ///< two surfaces meet between two pixels
    std::size_t mixed = 0;  ///< one or two pixels between them have values in between

    /// Whether the depth is surely averaged: at least 200 edges, three quarters of them mixed. Samples taken
    /// at single points have next to no mixed edges.
    bool are_of_means() const;
};

/// `depth` has one channel. Edges where nothing was hit on one side (infinite) do not count. [thread-safe]
DepthEdges find_depth_edges(const Image& depth);

}  // namespace aftershade
