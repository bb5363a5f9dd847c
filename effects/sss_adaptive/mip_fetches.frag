#version 450 core
#include <pass>
#include <scattering/facet.glsl>
#include <scattering/sampling.glsl>
#include <sequence.glsl>
#include "epoch.glsl"
#include "mip_level.glsl"

// What gather.frag fetches of the texture light, without fetching it. A sample between two levels takes of both.
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    ViewLines lines = view_lines();
    Facet here = read_facet(lines, p);
    int count = int(texelFetch(plan, p, 0).x);
    out_mip_fetches = vec4(0.0);
    out_far_mip_fetches = vec2(0.0);
    if (here.key == 0u) return;
    vec3 d = scattering_profile(here.key - 1u).d;
    float per_mm = pixels_per_mm(lines, here.depth_m);
    vec3 beyond_inner = max(burley_beyond(0.5 / per_mm, d), 1e-30);
    uvec2 start = first_point(texelFetch(epoch, p, 0).r);
    float fetches[6] = float[6](0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (int i = 0; i < count; ++i) {
        Sample drawn = draw_sample(d, beyond_inner, r2_point(start, uint(i)).y);
        float level = mip_level(per_mm * per_mm / (drawn.density * float(count)));
        int low = int(level);
        fetches[low] += 1.0;
        if (level > float(low)) fetches[min(low + 1, 5)] += 1.0;
    }
    out_mip_fetches = vec4(fetches[0], fetches[1], fetches[2], fetches[3]);
    out_far_mip_fetches = vec2(fetches[4], fetches[5]);
}
