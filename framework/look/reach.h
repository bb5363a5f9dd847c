// The pixels that a region depends on, found backwards from a look's outputs to the capture.
#pragma once

#include <optional>

#include "framework/image/image.h"
#include "framework/image/square_pixels.h"
#include "framework/look/pipeline.h"

namespace aftershade {

/// The part of a frame that a region needs to come out as in the whole frame, to the bit.
struct RegionNeeds {
    int margin_px = 0;  ///< around the region, as rendered
    int align_px = 1;   ///< the part begins and ends on multiples of this, where the effects' tiles do
};

/// nullopt: the whole frame. So it is where an effect says `"reach": "all"` or says nothing and does more
/// than read each pixel by itself; where a value is taken from the depth of a pixel or an object; where a
/// mask is a picture, which is stretched over the frame; where a step takes images of another frame, since
/// what moves is elsewhere there; and with a history, for the same reason. `scale`: of what is rendered,
/// relative to the full size.
std::optional<RegionNeeds> needs_of_region(const Pipeline& pipeline, double scale);

/// The same where steps work on square pixels: a stored pixel is at least as large as one of these.
std::optional<RegionNeeds> in_stored_pixels(const RegionNeeds& needs, const PixelStretch& stretch);

/// `region` with what it needs, inside `data`, which is the window of the whole frame; both as rendered.
Window window_with_needs(const Window& region, const RegionNeeds& needs, const Window& data);

}  // namespace aftershade
