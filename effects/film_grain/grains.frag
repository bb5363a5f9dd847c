#version 450 core
#include <pass>
#include "grain_place.glsl"
#include "one_grain.glsl"

// Each grain serves nine pixels or more.
void main() {
    out_grains = uvec4(floatBitsToUint(one_grain(ivec2(gl_FragCoord.xy) + first_grain())), 0u);
}
