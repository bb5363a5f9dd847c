#include "tile.glsl"

// Whether passes over near tiles draw in this one: elsewhere their textures hold what was in the memory before.
bool is_near(ivec2 tile) { return texelFetch(near_tile, tile, 0).r > 0.5; }
