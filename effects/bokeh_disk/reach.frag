#version 450 core
#include <pass>
#include "tile.glsl"

// A tile matters here if the gap between the two tiles is shorter than its largest radius.
void main() {
    ivec2 last = ivec2(tile_coc_size.xy) - 1, p = ivec2(gl_FragCoord.xy);
    int range = int(ceil(param.max_coc_radius / float(kTile)));
    vec4 largest = vec4(0.0);
    for (int y = max(p.y - range, 0); y <= min(p.y + range, last.y); ++y)
        for (int x = max(p.x - range, 0); x <= min(p.x + range, last.x); ++x) {
            vec4 tile = texelFetch(tile_coc, ivec2(x, y), 0);
            float gap_px = float((max(max(abs(x - p.x), abs(y - p.y)), 1) - 1) * kTile);
            largest.xy = max(largest.xy, mix(vec2(0.0), tile.xy, greaterThan(tile.xy, vec2(gap_px))));
            if (tile.w > gap_px && tile.z > largest.z) largest.zw = tile.zw;
        }
    out_reach = largest;
}
