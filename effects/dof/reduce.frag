#version 450 core
#include <pass>
#include <lens/packing.glsl>
#include "majority.glsl"

// SOURCE: `light`, or the finer level of `light_half`.
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), last = SOURCE_SIZE - 1;
    Light texels[4];
    for (int i = 0; i < 4; ++i) texels[i] = unpack_light(texelFetch(SOURCE, min(2 * p + ivec2(i & 1, i >> 1), last), 0));
    out_light_half = pack_light(majority(texels, p));
}
