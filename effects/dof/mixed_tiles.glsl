#include <lens/highlight.glsl>

bool mixed_tiles(ivec2 tile) { return texelFetch(tile_step, tile, 0).r > kOneSurfacePx && texelFetch(lit, tile, 0).r > 0.5; }
