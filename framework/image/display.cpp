#include "framework/image/display.h"

#include <cstddef>

#include "framework/image/image.h"
#include "framework/image/srgb.h"

namespace aftershade {

Image display_of_color(Image color, const Chromaticities& primaries) {
    if (primaries != kRec709) convert_colors(color, conversion_matrix(primaries, kRec709));
    Image display(color.width(), color.height(), 4);
    for (std::size_t i = 0; i < color.floats().size(); i += 4) {
        const float alpha = color.floats()[i + 3];
        for (std::size_t c = 0; c < 3; ++c) {
            const float premultiplied = color.floats()[i + c];
            const float straight = alpha >= kLeastAlpha ? premultiplied / alpha : premultiplied;
            display.floats()[i + c] = float(encode_srgb(straight));
        }
        display.floats()[i + 3] = alpha;
    }
    return display;
}

Image cropped_display(const Image& display, const Window& data, const Window& window, bool keeps_alpha) {
    bool opaque = !keeps_alpha && data.contains(window.min_x, window.min_y) &&
                  data.contains(window.max_x, window.max_y);
    for (int y = window.min_y; opaque && y <= window.max_y; ++y)
        for (int x = window.min_x; opaque && x <= window.max_x; ++x)
            opaque = display.at(x - data.min_x, y - data.min_y, 3) >= 1.0f;
    Image picture(window.width(), window.height(), opaque ? 3 : 4);
    for (int y = 0; y < window.height(); ++y)
        for (int x = 0; x < window.width(); ++x) {
            const int source_x = x + window.min_x - data.min_x;
            const int source_y = y + window.min_y - data.min_y;
            if (!data.contains(x + window.min_x, y + window.min_y)) continue;
            for (int c = 0; c < picture.channels(); ++c)
                picture.at(x, y, c) = display.at(source_x, source_y, c);
        }
    return picture;
}

}  // namespace aftershade
