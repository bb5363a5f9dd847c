#version 450 core
#include <pass>
#include "kernel.glsl"

const float kMostPixels = 59000.0;  // of one pass: see max_iterations

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Facet here = read_facet(p);
    out_sum = out_share = vec4(0.0);
    if (here.key == 0u) return;
    ViewLines lines = view_lines();
    ScatteringProfileRow profile = profile_of(here);
    vec3 at = view_position(lines, gl_FragCoord.xy, here.depth_m);
    // What is nearer to the camera by the whole reach looks the largest; half the depth bounds it.
    float nearest_m = max(here.depth_m - profile.reach / param.world_unit, 0.5 * here.depth_m);
    float most = 0.5 * sqrt(kMostPixels * float(pass.count)) - 1.0;
    int reach = int(min(ceil(profile.reach * pixels_per_mm(lines, nearest_m)), most));
    ivec2 low = max(p - reach, ivec2(0)), high = min(p + reach, frame.size - 1);
    vec3 sum = vec3(0.0), share = vec3(0.0);
    for (int y = low.y + pass.index; y <= high.y; y += pass.count)
        for (int x = low.x; x <= high.x; ++x) {
            ivec2 q = ivec2(x, y);
            Facet there = read_facet(q);
            bool near = all(lessThanEqual(abs(q - p), ivec2(kNear)));
            vec3 weight = share_from(profile, at, lines, there, q, vec2(q) + 0.5, 1.0);
            if (near || there.key != here.key) continue;
            sum += weight * there.light;
            share += weight;
        }
    out_sum = vec4(sum, 1.0);
    out_share = vec4(share, 1.0);
}
