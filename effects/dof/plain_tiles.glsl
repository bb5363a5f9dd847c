#include "blurred.glsl"

bool plain_tiles(ivec2 tile) { return is_blurred(tile) && !has_silhouettes(tile); }
