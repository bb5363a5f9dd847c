#version 450 core
#include <pass>
#include "blurred.glsl"
#include "edges.glsl"

void main() {
    ivec2 block = ivec2(gl_FragCoord.xy), tile = kBlock * block / kTile, last = ivec2(edges_size.xy) - 1;
    vec2 own = texelFetch(tile_coc, tile, 0).rg;
    float reach_px = max(-own.x, own.y) + 1.5;
    // Where nothing is blurred, neither is read.
    bool is_drawn = is_blurred(tile), may_hide = is_drawn && own.x < texelFetch(around, tile, 0).w - kClear;
    int narrow_range = is_drawn ? int(ceil(kFullSizePx / float(kBlock))) : -1, range = max(may_hide ? int(ceil(reach_px / float(kBlock))) : -1, narrow_range);
    out_beyond = vec2(kNoEdge, kNoNarrow);
    for (int y = max(block.y - range, 0); y <= min(block.y + range, last.y); ++y)
        for (int x = max(block.x - range, 0); x <= min(block.x + range, last.x); ++x) {
            ivec2 apart = abs(ivec2(x, y) - block);
            vec2 gap_px = float(kBlock) * vec2(max(apart - 1, ivec2(0))), found = texelFetch(edges, ivec2(x, y), 0).rg;
            if (may_hide && length(gap_px) <= reach_px) out_beyond.r = max(out_beyond.r, found.r);
            if (max(apart.x, apart.y) <= narrow_range) out_beyond.g = min(out_beyond.g, found.g);
        }
}
