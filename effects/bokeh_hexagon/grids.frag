#version 450 core
#include <pass>
#include "tile.glsl"

// What is blurred in a tile takes light from grid points in the tiles beside it.
void main() {
    ivec2 last = ivec2(reach_size.xy) - 1, p = ivec2(gl_FragCoord.xy);
    bool fine = false, coarse = false;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            float blur_px = texelFetch(reach, clamp(p + ivec2(x, y), ivec2(0), last), 0).g;
            fine = fine || (blur_px >= kLeastBlurPx && blur_px < kCoarsePx);
            coarse = coarse || blur_px >= kCoarsePx;
        }
    out_grids = vec4(texelFetch(reach, p, 0).rg, fine ? 1.0 : 0.0, coarse ? 1.0 : 0.0);
}
