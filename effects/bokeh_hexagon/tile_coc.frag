#version 450 core
#include <pass>
#include "tile.glsl"

void main() {
    ivec2 last = ivec2(coc_size.xy) - 1, corner = kTile * ivec2(gl_FragCoord.xy);
    vec2 largest = vec2(0.0);
    for (int y = 0; y < kTile; ++y)
        for (int x = 0; x < kTile; ++x) {
            float coc_px = texelFetch(coc, min(corner + ivec2(x, y), last), 0).r;
            largest = max(largest, vec2(-coc_px, abs(coc_px)));
        }
    out_tile_coc = largest;
}
