#version 450 core
#include <pass>
#include <scattering/facet.glsl>
#include "mark.glsl"
#include "mip_level.glsl"

// Mean over about the area that the sample stands for, where that is all of one object.
vec3 light_of_sample(Facet there, vec2 place, float area_px) {
#if PREFILTER
    vec4 mean = textureLod(light, place * light_size.zw, mip_level(area_px));
    return abs(mean.a - mark_of(there.key)) < 1e-4 ? mean.rgb : there.light;
#else
    return there.light;
#endif
}

#include <scattering/gather.glsl>

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    ViewLines lines = view_lines();
    Facet here = read_facet(lines, p);
    vec4 planned = texelFetch(plan, p, 0);
    int count = here.key == 0u ? 0 : int(planned.x);
    vec3 scattered = here.light, share = vec3(1.0);
    if (count > 0) {
        vec3 gathered = gathered_light(lines, p, here, samples_start(param.seed), count, share);
        scattered = mix(here.light, gathered, planned.z);
    }
    out_estimate = vec4(scattered, float(count));
    out_share = vec4(share, 0.0);
}
