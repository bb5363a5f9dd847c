#include "fine.glsl"

bool guessed_tiles(ivec2 tile) { return near_tiles(tile) && !has_fine_patches(tile); }
