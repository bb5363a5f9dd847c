#version 450 core
#include <pass>
#include "plan.glsl"
#if HYBRID != HYBRID_OFF
#include "shared_work.glsl"

// Range of the light around a pixel, between those of the tiles whose middles are nearest.
float range_around() {
    vec2 place = gl_FragCoord.xy / float(kTile) - 0.5;
    ivec2 low = ivec2(floor(place)), last = ivec2(tile_range_size.xy) - 1;
    vec4 range;
    for (int i = 0; i < 4; ++i)
        range[i] = texelFetch(tile_range, clamp(low + ivec2(i & 1, i >> 1), ivec2(0), last), 0).r;
    vec2 part = place - vec2(low);
    return mix(mix(range[0], range[1], part.x), mix(range[2], range[3], part.x), part.y);
}
#endif

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), q;
    bool inside = past_pixel(q);
    ViewLines lines = view_lines();
    Facet here = read_facet(lines, p);
    out_plan = vec4(0.0);
#if HYBRID != HYBRID_OFF
    out_epoch = vec2(0.0);
    out_sampled = 0.0;
#endif
    if (here.key == 0u) return;
    Plan now = planned(lines, here, inside, texelFetch(history_prev, q, 0), texelFetch(epoch_prev, q, 0).r);
    out_plan = vec4(now.count, now.known ? 1.0 : 0.0, now.scattered, now.wanted);
#if HYBRID != HYBRID_OFF
    out_sampled = sampled_ids(here.key - 1u) ? share_of_range(range_around()) : 0.0;
    if (out_sampled == 0.0) out_plan = vec4(0.0, -1.0, out_plan.zw);
    out_epoch = vec2(now.each, out_plan.x);
#endif
}
