#version 450 core
#include <pass>
#include "place.glsl"
#include "bend.glsl"

// How much the normal turns over the surface beside a pixel: squares of the turn and of the way, whose quotient's root is
// the curvature, 1/mm. Differences to pixels of the same surface, not dFdx, which would see 2x2 blocks and silhouettes.
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    uint key = key_at(at);
    float depth_m = texelFetch(surface, at, 0).a;
    vec3 n = texelFetch(normal, at, 0).xyz, p = place_mm(gl_FragCoord.xy, depth_m);
    int step_px = bend_step(key, depth_m);
    vec2 sum = vec2(0.0);
    const ivec2 sides[4] = ivec2[](ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1));
    for (int i = 0; i < 4; ++i) {
        ivec2 there = at + step_px * sides[i];
        if (key == 0u || any(lessThan(there, ivec2(0))) || any(greaterThanEqual(there, frame.size))) continue;
        if (key_at(there) != key) continue;
        vec3 turn = texelFetch(normal, there, 0).xyz - n;
        vec3 way = place_mm(there) - p;
        // So steep a way leads over an edge within the surface.
        if (abs(way.z) > 4.0 * length(way.xy)) continue;
        sum += vec2(dot(turn, turn), dot(way, way));
    }
    out_bend = sum;
}
