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
    float furthest = 0.0, largest_step = 0.0;
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x) {
            furthest = max(furthest, reach_px(texelFetch(coc, ivec2(x, y), 0).r, path_at(ivec2(x, y))));
            largest_step = max(largest_step, step_at(ivec2(x, y)));
        }
    out_reach_tile = vec2(furthest, largest_step > 0.5 * kClearPx ? 1.0 : 0.0);
}
