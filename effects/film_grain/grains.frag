#version 450 core
#include <pass>
#include "grain_place.glsl"
#include "grain_bits.glsl"
#include "one_grain.glsl"

flat in uvec3 key;

// Each grain serves nine pixels or more.
void main() {
    uvec2 bits = grain_bits(one_grain(ivec2(gl_FragCoord.xy) + first_grain(), key));
    out_grains = bits.x;
#ifdef HAS_OUT_GRAINS_BLUE
    out_grains_blue = bits.y;
#endif
}
