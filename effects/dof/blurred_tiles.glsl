#include "blurred.glsl"

bool blurred_tiles(ivec2 tile) { return is_blurred(tile); }
