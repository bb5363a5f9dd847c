// Sides in px, as effect.json declares them: of the tiles of tile_coc and around; of the blocks of edges and beyond.
const int kTile = 16, kBlock = 8;

int tiles_in_a_row() { return (frame.size.x + kTile - 1) / kTile; }

// Difference of two CoC radii, px, from which on one surface is clearly in front of the other.
const float kClear = 1.0;

// CoC radius, px, from which on a pixel's light may be a highlight.
const float kLeastHighlightRadiusPx = 2.0;
