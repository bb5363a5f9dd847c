#include "plated.glsl"

bool silhouette_tiles(ivec2 tile) { return is_blurred(tile) && is_plated(tile); }
