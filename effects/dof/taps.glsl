#include <lens/packing.glsl>
#include "outline.glsl"
#include "reach.glsl"
#include "coarse.glsl"

// Surfaces whose CoC radii differ by less are one, by more are two; between, both.
float in_front(float tap_coc, float coc) { return clamp(coc - tap_coc, 0.0, 1.0); }

Light tap_light(ivec2 texel) { return unpack_light(texelFetch(light, clamp(texel, ivec2(0), frame.size - 1), 0)); }
Light tap_coarse(ivec2 texel, Grid grid) { return unpack_light(texelFetch(coarse, clamp(texel, ivec2(0), grid.last) + grid.origin, 0)); }

float coarse_coc_at(ivec2 texel, Grid grid) { return texelFetch(coarse_coc, clamp(texel, ivec2(0), grid.last) + grid.origin, 0).r; }

// CoC radius of texels of `patches` and `plate` that show what `light` shows: infinity as a half, as effect.json clears them.
const uvec4 kNoPatch = uvec4(0u, 0u, 0u, 0x7c000000u);
bool is_patch(Light texel) { return texel.coc < kHalfInfinity; }
