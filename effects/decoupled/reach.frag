#version 450 core
#include <pass>

const int kTile = 16;

// A tile matters here if the gap between the two tiles is shorter than its furthest way.
void main() {
    ivec2 last = ivec2(reach_tile_size.xy) - 1, p = ivec2(gl_FragCoord.xy);
    int range = int(ceil((param.max_coc_radius + param.max_blur) / float(kTile)));
    float furthest = 0.0;
    for (int y = max(p.y - range, 0); y <= min(p.y + range, last.y); ++y)
        for (int x = max(p.x - range, 0); x <= min(p.x + range, last.x); ++x) {
            float tile = texelFetch(reach_tile, ivec2(x, y), 0).r;
            float gap_px = float((max(max(abs(x - p.x), abs(y - p.y)), 1) - 1) * kTile);
            if (tile > gap_px - 1.0) furthest = max(furthest, tile);
        }
    out_reach = furthest;
}
