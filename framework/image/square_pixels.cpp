#include "framework/image/square_pixels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace aftershade {

namespace {

constexpr double kNearEnough = 1.0 / 2000;
constexpr double kMostAspect = 1e6;  // OpenEXR's limit, and of its inverse

}  // namespace

std::int64_t PixelStretch::edge(std::int64_t px) const {
    const std::int64_t twice = 2 * px * to + from, by = 2 * from;
    return twice >= 0 ? twice / by : -((by - 1 - twice) / by);
}

PixelStretch square_pixels(float pixel_aspect) {
    const double aspect = double(pixel_aspect), longer = std::max(aspect, 1 / aspect);
    if (!(aspect > 0 && longer <= kMostAspect)) return {};
    PixelStretch stretch{aspect > 1 ? 0 : 1, 0, 1};
    for (;; ++stretch.from) {
        stretch.to = std::llround(longer * double(stretch.from));
        if (std::abs(stretch.scale(stretch.axis) / longer - 1) <= kNearEnough) break;
    }
    return stretch.is_none() ? PixelStretch{} : stretch;
}

Window stretched(const Window& window, const Window& display, const PixelStretch& stretch) {
    if (stretch.is_none()) return window;
    const auto edge = [&](std::int64_t px, int corner) {
        constexpr std::int64_t kMost = std::numeric_limits<int>::max() / 2;
        return int(std::clamp(corner + stretch.edge(px - corner), -kMost, kMost));
    };
    Window result = window;
    if (stretch.axis == 0) {
        result.min_x = edge(window.min_x, display.min_x);
        result.max_x = edge(std::int64_t(window.max_x) + 1, display.min_x) - 1;
    } else {
        result.min_y = edge(window.min_y, display.min_y);
        result.max_y = edge(std::int64_t(window.max_y) + 1, display.min_y) - 1;
    }
    return result;
}

}  // namespace aftershade
