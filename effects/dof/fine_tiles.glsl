#include "fine.glsl"

bool fine_tiles(ivec2 tile) { return has_fine_patches(tile); }
