#version 450 core
#include <pass>
#include "tile.glsl"

void main() {
    ivec2 last = ivec2(coc_size.xy) - 1;
    ivec2 corner = ivec2(gl_FragCoord.xy) * kTile;
    float near = 0.0;
    for (int y = 0; y < kTile; ++y)
        for (int x = 0; x < kTile; ++x) near = max(near, -texelFetch(coc, min(corner + ivec2(x, y), last), 0).r);
    out_near_tile = near;
}
