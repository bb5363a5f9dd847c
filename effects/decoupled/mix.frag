#version 450 core
#include <pass>
#include "met.glsl"
#include "surfel.glsl"

#ifdef HAS_IN_TURN
float is_traced(ivec2 tile) { return texelFetch(meet, clamp(tile, ivec2(0), ivec2(meet_size.xy) - 1), 0).r > 0.0 ? 1.0 : 0.0; }

// 0 at the edges of what is traced, 1 from the middle of its outermost tiles on.
float inside(ivec2 p) {
    vec2 at = (vec2(p) + 0.5) / 16.0 - 0.5, part = fract(at);
    ivec2 tile = ivec2(floor(at));
    float above = mix(is_traced(tile), is_traced(tile + ivec2(1, 0)), part.x);
    float below = mix(is_traced(tile + ivec2(0, 1)), is_traced(tile + ivec2(1, 1)), part.x);
    return clamp(2.0 * mix(above, below, part.y) - 1.0, 0.0, 1.0);
}

// `motion_blur` takes light from along the way, which the lens may have blurred there alone: the most that it blurs, px.
float dragged_px(ivec2 p, float samples) {
    vec4 path = path_at(p);
    int steps = int(ceil(0.5 * longest_way_px(path)));
    float most_px = 0.0;
    for (int i = -steps; i <= steps; ++i) {
        vec2 way = way_px(path, kMiddle + 0.5 * float(i) / float(max(steps, 1)));
        ivec2 q = clamp(ivec2(floor(vec2(p) + way + 0.5)), ivec2(0), frame.size - 1);
        float disc_px = texelFetch(highlights, q, 0).a > 0.0 ? kMetPx : 0.0;
        most_px = max(most_px, max(texelFetch(met, q, 0).r / samples, disc_px));
    }
    return most_px;
}

float met_at(ivec2 p, float samples) {
    float is_inside = inside(p);
    if (is_inside == 0.0) return 0.0;
    return is_inside * smoothstep(kApartPx, kMetPx, min(dragged_px(p, samples), texelFetch(met, p, 0).g / samples));
}
#endif

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float samples = float(param.samples);
    vec4 traced = texelFetch(color, p, 0) + texelFetch(sum, p, 0) / samples + vec4(texelFetch(highlights, p, 0).rgb, 0.0);
#ifdef HAS_IN_TURN
    out_color = mix(texelFetch(in_turn, p, 0), traced, met_at(p, samples));
#else
    out_color = traced;
#endif
    out_shares = texelFetch(gaps, p, 0).rg / samples;
}
