// Side in px of the tiles of tile_coc, reach and grids, as effect.json declares it.
const int kTile = 16;

// A smaller CoC radius blurs nothing.
const float kLeastBlurPx = 0.5;

// Radius from which on a tile is blurred on the coarse grid. There, smaller hexagons would lose their corners.
const float kCoarsePx = 12.0;
