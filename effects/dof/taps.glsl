#include <lens/packing.glsl>
#include "outline.glsl"
#include "reach.glsl"

// Surfaces whose CoC radii differ by less are one, by more are two; between, both.
float in_front(float tap_coc, float coc) { return clamp(coc - tap_coc, 0.0, 1.0); }

// CoC radius of texels of `patches` and `plate` that show what `light` shows: infinity as a half, as effect.json clears them.
const uvec4 kNoPatch = uvec4(0u, 0u, 0u, 0x7c000000u);
bool is_patch(Light texel) { return texel.coc < kHalfInfinity; }
