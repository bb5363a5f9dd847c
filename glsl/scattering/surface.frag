#version 450 core
#include <pass>
#include <scattering/key.glsl>
#include <scattering/lines.glsl>

// Surface is spread over its pixels at most ten times: what is nearer to edge-on has no reliable slope.
const float kMostSlope = 9.95;

// Depth's change from a pixel to its neighbour over their distance, for small steps: large where the neighbour is another
// object, so that the other side's is taken.
float step_to(ivec2 p, ivec2 neighbour, float depth_m, float px) {
    ivec2 q = clamp(neighbour, ivec2(0), frame.size - 1);
    float there_m = texelFetch(depth, q, 0).r;
    bool same = q == neighbour && is_surface(there_m) && key_at(q) == key_at(p);
    return same ? (there_m - depth_m) / (px * 0.5 * (depth_m + there_m)) : 1e30;
}

// The mean of both sides where they go on from each other, else the flatter: across a fold within one object the other side
// is another surface.
float slope_between(float before, float after) {
    float flatter = abs(before) < abs(after) ? -before : after;
    bool goes_on = abs(before + after) < 0.5 + abs(flatter);
    float slope = goes_on ? 0.5 * (after - before) : flatter;
    return abs(slope) < 1e29 ? clamp(slope, -kMostSlope, kMostSlope) : 0.0;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec3 light = texelFetch(irradiance, p, 0).rgb;
    float depth_m = texelFetch(depth, p, 0).r, px = view_lines().slope.x;
    bool scatters = is_surface(depth_m) && may_scatter(p, light);
    vec2 slope = vec2(
        slope_between(step_to(p, p - ivec2(1, 0), depth_m, px), step_to(p, p + ivec2(1, 0), depth_m, px)),
        slope_between(step_to(p, p - ivec2(0, 1), depth_m, px), step_to(p, p + ivec2(0, 1), depth_m, px)));
    slope *= min(1.0, kMostSlope / max(length(slope), 1e-6));
    out_surface = vec4(light, scatters ? depth_m : 3e38);
    out_facet = scatters ? uvec2(key_at(p), packHalf2x16(slope)) : uvec2(0u);
}
