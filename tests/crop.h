// A window cut out of a capture, as a renderer's region or overscan gives it.
#pragma once

#include "framework/capture/capture_window.h"

namespace aftershade::test {

/// `window` in pixels of the whole image; the display window stays what it was.
inline Capture cropped(Capture whole, const Window& window) {
    crop_capture(whole, window);
    return whole;
}

/// Whether `part`, which lies at `window`, has the same floats as `whole` there.
inline bool same_in_window(const Image& whole, const Image& part, const Window& window) {
    for (int y = 0; y < part.height(); ++y)
        for (int x = 0; x < part.width(); ++x)
            for (int c = 0; c < part.channels(); ++c)
                if (part.at(x, y, c) != whole.at(x + window.min_x, y + window.min_y, c)) return false;
    return part.width() == window.width() && part.height() == window.height();
}

}  // namespace aftershade::test
