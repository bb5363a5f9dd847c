#include "highlight.glsl"

bool repaired_tiles(ivec2 tile) { return may_be_repaired(texelFetch(coc_step, tile, 0)); }
