#version 450 core
#include <pass>
#include "tile.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    int last = int(tile_coc_size.x) - 1, range = int(ceil(param.max_coc_radius / float(kTile)));
    float widest_px = 0.0;
    for (int x = max(p.x - range, 0); x <= min(p.x + range, last); ++x) {
        vec2 coc_px = texelFetch(tile_coc, ivec2(x, p.y), 0).rg;
        widest_px = max(widest_px, max(-coc_px.x, coc_px.y));
    }
    out_widest = widest_px;
}
