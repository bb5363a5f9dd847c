#version 450 core
#include <pass>
#include "loads.glsl"
#include "plate_at.glsl"
#include "majority.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), last = (frame.size + 1 >> 1) - 1;
    Light texels[4];
    for (int i = 0; i < 4; ++i) texels[i] = half_plate_at(min(2 * p + ivec2(i & 1, i >> 1), last));
    out_plate_quarter = pack_light(majority(texels, p));
}
