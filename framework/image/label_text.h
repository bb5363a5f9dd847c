// Short ASCII text drawn into a picture, in stb_easy_font.
#pragma once

#include <array>
#include <string_view>

#include "framework/image/image.h"

namespace aftershade {

using DisplayColor = std::array<float, 3>;  ///< encoded, 0..1

constexpr int kTextLineHeight_px = 12;  ///< at scale 1

/// Width in px of one line at scale 1. Characters other than printable ASCII count, and are drawn, as '?'.
int text_width_px(std::string_view text);

/// Draws one line with its upper left corner at (x, y), every dot as a square of scale x scale px; what does
/// not fit into `max_width_px` is left out and ends in "..".
void draw_text(Image& picture, int x, int y, std::string_view text, int scale, int max_width_px,
               DisplayColor color);

/// x, y, width and height are cut to the picture.
void fill_rectangle(Image& picture, int x, int y, int width, int height, DisplayColor color);

}  // namespace aftershade
