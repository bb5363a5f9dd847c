#include "highlight.glsl"

// Two steps lead to a diagonal neighbour.
bool repaired_tiles(ivec2 tile) { return texelFetch(coc_step, tile, 0).r > 0.5 * kOneSurfacePx; }
