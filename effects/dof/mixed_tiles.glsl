#include <lens/highlight.glsl>

bool mixed_tiles(ivec2 tile) { return texelFetch(coc_step, tile, 0).r > kOneSurfacePx; }
