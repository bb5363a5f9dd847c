#version 450 core
#include <pass>
#include <lens/packing.glsl>
#include "coarse.glsl"

// The level of `light` that a texel is part of; 0 between them.
int level_at(ivec2 p) {
    for (int level = 1; level <= 3; ++level) {
        Grid grid = grid_of(level);
        if (all(greaterThanEqual(p, grid.origin)) && all(lessThanEqual(p - grid.origin, grid.last))) return level;
    }
    return 0;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    int level = level_at(p);
    ivec2 texel = p - grid_of(level).origin;
    out_light = uvec4(0u);
    if (level == 1) out_light = texelFetch(light_half, texel, 0);
    if (level == 2) out_light = texelFetch(light_half, texel, 1);
    if (level == 3) out_light = texelFetch(light_half, texel, 2);
    out_coarse_coc = unpack_light(out_light).coc;
}
