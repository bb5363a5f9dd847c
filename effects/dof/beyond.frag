#version 450 core
#include <pass>
#include "blurred.glsl"
#include "edges.glsl"

void main() {
    ivec2 block = ivec2(gl_FragCoord.xy), tile = kBlock * block / kTile, last = ivec2(edges_size.xy) - 1;
    vec2 own = texelFetch(tile_coc, tile, 0).rg;
    float reach_px = max(-own.x, own.y) + 1.5;
    bool may_hide = is_blurred(tile) && own.x < texelFetch(around, tile, 0).w - kClear;
    int range = may_hide ? int(ceil(reach_px / float(kBlock))) : -1;
    out_beyond = kNoEdge;
    for (int y = max(block.y - range, 0); y <= min(block.y + range, last.y); ++y)
        for (int x = max(block.x - range, 0); x <= min(block.x + range, last.x); ++x) {
            vec2 gap_px = float(kBlock) * vec2(max(abs(ivec2(x, y) - block) - 1, ivec2(0)));
            if (length(gap_px) <= reach_px) out_beyond = max(out_beyond, texelFetch(edges, ivec2(x, y), 0).r);
        }
}
