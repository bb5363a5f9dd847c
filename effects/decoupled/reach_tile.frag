#version 450 core
#include <pass>
#include "order.glsl"
#include "surfel.glsl"

const int kTile = 16;

float step_at(ivec2 p) {
    float own = texelFetch(order, p, 0).r;
    vec2 beside = vec2(texelFetch(order, min(p + ivec2(1, 0), frame.size - 1), 0).r, texelFetch(order, min(p + ivec2(0, 1), frame.size - 1), 0).r);
    return max(abs(beside.x - own), abs(beside.y - own));
}

// How far lens and shutter move something here, and whether there is a silhouette.
void main() {
    ivec2 corner = kTile * ivec2(gl_FragCoord.xy), end = min(corner + kTile, frame.size);
    float furthest_px = 0.0, largest_step = 0.0;
    vec2 orders_here = vec2(1e9, -1e9);
    vec2 blurs_px = vec2(0.0);
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x) {
            float coc_px = texelFetch(coc, ivec2(x, y), 0).r;
            vec4 path = path_at(ivec2(x, y));
            furthest_px = max(furthest_px, reach_px(coc_px, path));
            blurs_px = max(blurs_px, vec2(abs(coc_px), longest_way_px(path)));
            float own_order = texelFetch(order, ivec2(x, y), 0).r;
            orders_here = vec2(min(orders_here.x, own_order), max(orders_here.y, own_order));
            largest_step = max(largest_step, step_at(ivec2(x, y)));
        }
    out_reach_tile = vec2(furthest_px, largest_step > 0.5 * kClearPx ? 1.0 : 0.0);
#ifdef HAS_OUT_ORDERS
    out_orders = orders_here;
#endif
#ifdef HAS_OUT_BLURS
    out_blurs = blurs_px;
#endif
}
