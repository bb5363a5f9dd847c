#version 450 core
#include <pass>
#include "drawn.glsl"
#include "plan.glsl"
#include "update.glsl"
#if GUIDING
#include "guide.glsl"
#endif
#include <scattering/mixed.glsl>

// All that a pixel needs in one pass, which writes neither plan nor estimate.
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), q;
    bool inside = past_pixel(q);
    ViewLines lines = view_lines();
    Facet here = read_facet(lines, p);
    keep_nothing();
    out_epoch = 0.0;
    out_irradiance = texelFetch(irradiance, p, 0);
    if (here.key == 0u) return;
    vec4 past = texelFetch(history_prev, q, 0);
    Plan plan_here = planned(lines, here, inside, past, texelFetch(epoch_prev, q, 0).r);
    Gathered sums = drawn(lines, p, here, plan_here.count, plan_here.each);
    vec3 scattered = mix(here.light, filled(sums), plan_here.scattered);
    out_epoch = plan_here.each;
    keep_moments(here, q, past, plan_here.known, plan_here.count, viewed(scattered));
#if GUIDING
    Guided now = guided_light(p, sums, plan_here.count, q, plan_here.known);
    keep_average(now);
    scattered = in_part(here.light, filled(now.sums), plan_here.scattered);
#endif
    out_irradiance = mixed_result(p, here.key, scattered);
}
