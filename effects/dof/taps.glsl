#include <lens/packing.glsl>
#include "outline.glsl"
#include "reach.glsl"

// Surfaces whose CoC radii differ by less are one, by more are two; between, both.
float in_front(float tap_coc, float coc) { return clamp(coc - tap_coc, 0.0, 1.0); }

Light tap_light(ivec2 texel, int level) {
    // Not textureSize, which llvmpipe answers for the level of the first of its lanes.
    ivec2 last = max(frame.size >> level, ivec2(1)) - 1;
    return unpack_light(texelFetch(light, clamp(texel, ivec2(0), last), level));
}

// CoC radius of texels of `patches` and `plate` that show what `light` shows: infinity as a half, as effect.json clears them.
const uvec4 kNoPatch = uvec4(0u, 0u, 0u, 0x7c000000u);
bool is_patch(Light texel) { return !isinf(texel.coc); }
