#version 450 core
#include <pass>
#include "kernel.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Facet here = read_facet(p);
    out_sum = out_share = vec4(0.0);
    if (here.key == 0u) return;
    ViewLines lines = view_lines();
    ScatteringProfileRow profile = profile_of(here);
    vec3 at = view_position(lines, gl_FragCoord.xy, here.depth_m);
    vec3 own = profile_within(profile, 0.5 / pixels_per_mm(lines, here.depth_m));
    vec3 sum = own * here.light, share = own;
    for (int i = 0; i < (2 * kNear + 1) * (2 * kNear + 1); ++i) {
        ivec2 q = p + ivec2(i % (2 * kNear + 1), i / (2 * kNear + 1)) - kNear;
        bool inside = all(greaterThanEqual(q, ivec2(0))) && all(lessThan(q, frame.size));
        Facet there = read_facet(clamp(q, ivec2(0), frame.size - 1));
        if (!inside || there.key != here.key) continue;
        for (int k = 0; k < kGrid * kGrid; ++k) {
            vec2 place = vec2(q) + (vec2(k % kGrid, k / kGrid) + 0.5) / float(kGrid);
            if (distance(place, gl_FragCoord.xy) <= 0.5) continue;
            vec3 weight = share_from(profile, at, lines, there, q, place, 1.0 / float(kGrid * kGrid));
            sum += weight * there.light;
            share += weight;
        }
    }
    out_sum = vec4(sum, 1.0);
    out_share = vec4(share, 1.0);
}
