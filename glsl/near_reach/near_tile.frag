#version 450 core
#include <pass>
#include "tile.glsl"

void main() {
    ivec2 last = ivec2(coc_size.xy) - 1;
    ivec2 corner = ivec2(gl_FragCoord.xy) * kTile;
    float near = 0.0;
    // From a place that varies, so that no compiler unrolls the loops.
    ivec2 p = corner;
    do {
        p.x = corner.x;
        do {
            near = max(near, -texelFetch(coc, min(p, last), 0).r);
        } while (++p.x < corner.x + kTile);
    } while (++p.y < corner.y + kTile);
    out_near_tile = near;
}
