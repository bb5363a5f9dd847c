// Which pixels of an image a pixel of its thumbnail stands for.
#pragma once

#include <algorithm>
#include <cstdint>

namespace aftershade {

/// Along one side: `first` up to, not including, `last`.
struct Footprint {
    int first = 0, last = 0;
    Footprint(int at, int tile_px, int image_px)
        : first(int(std::int64_t(at) * image_px / tile_px)),
          last(std::max(int(std::int64_t(at + 1) * image_px / tile_px), first + 1)) {}
    int middle() const { return (first + last) / 2; }
    int step() const { return std::max(1, (last - first) / 4); }  // of 4 x 4 samples, the eye needs no more
};

}  // namespace aftershade
