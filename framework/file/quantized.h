// Display-referred values as the whole numbers that files of pictures hold.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace aftershade {

/// round(largest Unsigned * clamp(value, 0, 1)), NaN as 0.
template <class Unsigned>
Unsigned quantized(float value) {
    constexpr float kLargest = std::numeric_limits<Unsigned>::max();
    if (!(value > 0.0f)) return 0;  // NaN, too
    return static_cast<Unsigned>(std::lround(kLargest * std::min(value, 1.0f)));
}

}  // namespace aftershade
