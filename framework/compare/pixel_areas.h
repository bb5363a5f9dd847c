// Which pixels of two images count, and under which limits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "framework/compare/difference_rules.h"

namespace aftershade {

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
