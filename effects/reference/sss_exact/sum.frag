#version 450 core
#include <pass>
#include <scattering/share.glsl>

const float kMostPixels = 59000.0;  // of one pass: see max_iterations

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    ViewLines lines = view_lines();
    Facet here = read_facet(lines, p);
    out_sum = out_share = vec4(0.0);
    if (here.key == 0u) return;
    ScatteringProfileRow profile = scattering_profile(here.key - 1u);
    // What is nearer to the camera by the whole reach looks the largest; half the depth bounds it.
    float nearest_m = max(here.depth_m - profile.reach / param.world_unit, 0.5 * here.depth_m);
    float most = 0.5 * sqrt(kMostPixels * float(pass.count)) - 1.0;
    int reach = int(min(ceil(profile.reach * pixels_per_mm(lines, nearest_m)), most));
    ivec2 low = max(p - reach, ivec2(0)), high = min(p + reach, frame.size - 1);
    vec3 share = pass.index == 0 ? own_share(profile, here) : vec3(0.0);
    vec3 sum = share * here.light;
    for (int y = low.y + pass.index; y <= high.y; y += pass.count)
        for (int x = low.x; x <= high.x; ++x) {
            Facet there = read_facet(lines, ivec2(x, y));
            vec3 weight = share_of(profile, here, there);
            if (there.key != here.key || ivec2(x, y) == p) continue;
            sum += weight * there.light;
            share += weight;
        }
    out_sum = vec4(sum, 1.0);
    out_share = vec4(share, 1.0);
}
