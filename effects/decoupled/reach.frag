#version 450 core
#include <pass>
#include "tiles.glsl"

// A tile matters here if the gap between the two tiles is shorter than its furthest way; its silhouettes, if what is hidden behind
// them may come to light here.
void main() {
    ivec2 last = ivec2(reach_tile_size.xy) - 1, p = ivec2(gl_FragCoord.xy);
    int range = int(ceil((param.max_coc_radius + param.max_blur) / float(kTile)));
    float furthest_px = 0.0;
    for (int y = max(p.y - range, 0); y <= min(p.y + range, last.y); ++y)
        for (int x = max(p.x - range, 0); x <= min(p.x + range, last.x); ++x) {
            float tile = texelFetch(reach_tile, ivec2(x, y), 0).r;
            if (tile > gap_px(ivec2(x, y) - p) - 1.0) furthest_px = max(furthest_px, tile);
        }
    float sees_px = texelFetch(reach_tile, p, 0).r + furthest_px + 1.5, has_silhouette = 0.0, furthest_order = -1e9;
    int around = min(int(ceil(sees_px / float(kTile))), range);
    for (int y = max(p.y - around, 0); y <= min(p.y + around, last.y); ++y)
        for (int x = max(p.x - around, 0); x <= min(p.x + around, last.x); ++x)
            if (gap_px(ivec2(x, y) - p) < sees_px) {
                has_silhouette = max(has_silhouette, texelFetch(reach_tile, ivec2(x, y), 0).g);
#ifdef HAS_ORDERS
                furthest_order = max(furthest_order, texelFetch(orders, ivec2(x, y), 0).g);
#endif
            }
    out_reach = vec2(furthest_px, furthest_px < 0.5 ? 0.0 : has_silhouette);
#ifdef HAS_OUT_BEHIND_ORDER
    out_behind_order = furthest_order;
#endif
}
