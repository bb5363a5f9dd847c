#include "highlight.glsl"

bool repaired_tiles(ivec2 tile) { return is_repaired(texelFetch(coc_step, tile, 0).r); }
