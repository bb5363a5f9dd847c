// Side in px of the tiles of tile_coc and reach, as effect.json declares it.
const int kTile = 16;

// A smaller CoC radius blurs nothing.
const float kLeastBlurPx = 0.5;

// A highlight counts by its light spread over its disk, or over this many px where that is larger: a small disk beside a
// surface that is merely brighter is none.
const float kLeastSpreadPx = 50.0;

const float kPi = 3.14159265358979;
