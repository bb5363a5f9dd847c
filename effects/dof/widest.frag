#version 450 core
#include <pass>
#include "tile.glsl"

void main() {
    ivec2 last = ivec2(tile_coc_size.xy) - 1, corner = kTilesOfBlock * ivec2(gl_FragCoord.xy);
    float widest_px = 0.0;
    for (int i = 0; i < kTilesOfBlock * kTilesOfBlock; ++i) {
        vec2 coc_px = texelFetch(tile_coc, min(corner + ivec2(i % kTilesOfBlock, i / kTilesOfBlock), last), 0).rg;
        widest_px = max(widest_px, max(-coc_px.x, coc_px.y));
    }
    out_widest = widest_px;
}
