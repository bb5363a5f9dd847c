#include "plated.glsl"

bool plain_tiles(ivec2 tile) { return is_blurred(tile) && !is_plated(tile); }
