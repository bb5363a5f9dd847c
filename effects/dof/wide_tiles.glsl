#include "wide.glsl"

bool wide_tiles(ivec2 tile) { return is_blurred(tile) && is_wide(tile); }
