#version 450 core
#include <pass>
#include "tile.glsl"

// How many tiles away one may lie that reaches tile p.
int range_of(ivec2 p) {
    int last = int(widest_size.y) - 1, range = int(ceil(param.max_coc_radius / float(kTile)));
    float widest_px = 0.0;
    for (int y = max(p.y - range, 0); y <= min(p.y + range, last); ++y) widest_px = max(widest_px, texelFetch(widest, ivec2(p.x, y), 0).r);
    return min(int(ceil((widest_px + 1.0) / float(kTile))), range);
}

// A tile matters here if the gap between the two tiles is shorter than its largest radius.
void main() {
    ivec2 last = ivec2(tile_coc_size.xy) - 1, p = ivec2(gl_FragCoord.xy);
    int range = range_of(p);
    vec4 own = texelFetch(tile_coc, p, 0);
    float smallest = own.x, largest = own.y, before = own.z;
    for (int y = max(p.y - range, 0); y <= min(p.y + range, last.y); ++y)
        for (int x = max(p.x - range, 0); x <= min(p.x + range, last.x); ++x) {
            vec4 tile = texelFetch(tile_coc, ivec2(x, y), 0);
            float gap_px = float((max(max(abs(x - p.x), abs(y - p.y)), 1) - 1) * kTile);
            if (max(-tile.x, tile.y) <= gap_px - 1.0) continue;
            smallest = min(smallest, tile.x);
            largest = max(largest, tile.y);
            float bound = own.y - kClear;
            if (tile.x < bound) before = max(before, tile.y < bound ? tile.y : tile.z < bound ? tile.z : own.y);
        }
    out_around = vec4(smallest, before, own.y, largest);
}
