// A window cut out of a capture, as a renderer's region or overscan gives it.
#pragma once

#include "framework/image/capture.h"

namespace aftershade::test {

/// `window` in pixels of the whole image; the display window stays what it was.
inline Capture cropped(const Capture& whole, const Window& window) {
    Capture result;
    result.header = whole.header;
    result.header.data_window = window;
    for (const auto& [role, image] : whole.images) {
        Image& part = result.images[role] =
            Image(window.width(), window.height(), image.channels(), image.type());
        for (int y = 0; y < part.height(); ++y)
            for (int x = 0; x < part.width(); ++x)
                for (int c = 0; c < part.channels(); ++c)
                    if (image.type() == ComponentType::float32)
                        part.at(x, y, c) = image.at(x + window.min_x, y + window.min_y, c);
                    else part.uint_at(x, y, c) = image.uint_at(x + window.min_x, y + window.min_y, c);
    }
    return result;
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
