#version 450 core
#include <pass>
#include "loads.glsl"
#include "plate_at.glsl"
#include "majority.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Light texels[4];
    for (int i = 0; i < 4; ++i) texels[i] = plate_at(min(2 * p + ivec2(i & 1, i >> 1), frame.size - 1));
    // Blurs beside tiles in focus look at the plate there too.
    bool is_blurred = texelFetch(blur_tile, min(2 * p, frame.size - 1) / kTile, 0).r > 0.5;
    out_plate_half = is_blurred ? pack_light(majority(texels, p)) : uvec4(0u);
}
