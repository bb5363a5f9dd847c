#include "plated.glsl"
#include "levels.glsl"

// Whether a blur of this tile or what reaches it is gathered at a quarter of the size.
bool is_wide(ivec2 tile) { return has_coarse_levels() && widest_radius_px(texelFetch(around, tile, 0)) > kHalfSizePx; }
