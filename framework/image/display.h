// The transform from scene-linear colours to a display.
#pragma once

#include "framework/image/color_space.h"
#include "framework/image/image.h"

namespace aftershade {

/// From premultiplied scene-linear RGBA to display-referred RGB of an sRGB monitor with straight alpha.
Image display_of_color(Image color, const Chromaticities& primaries);

/// The pixels of `window` out of an RGBA picture over the window `data`; 0 where that does not reach. An
/// opaque picture loses its alpha unless `keeps_alpha`.
Image cropped_display(const Image& display, const Window& data, const Window& window,
                      bool keeps_alpha = false);

}  // namespace aftershade
