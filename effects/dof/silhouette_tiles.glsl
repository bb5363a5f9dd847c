#include "blurred.glsl"

bool silhouette_tiles(ivec2 tile) { return is_blurred(tile) && has_silhouettes(tile); }
