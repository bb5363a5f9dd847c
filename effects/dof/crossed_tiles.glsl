#include <lens/highlight.glsl>

bool crossed_tiles(ivec2 tile) { return may_be_repaired(texelFetch(tile_step, tile, 0)); }
