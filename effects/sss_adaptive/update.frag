#version 450 core
#include <pass>
#include "update.glsl"
#if GUIDING
#include "guide.glsl"
#endif

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), q;
    past_pixel(q);
    ViewLines lines = view_lines();
    Facet here = read_facet(lines, p);
    keep_nothing();
    if (here.key == 0u) return;
    vec4 plan_here = texelFetch(plan, p, 0), drawn = texelFetch(estimate, p, 0), past = texelFetch(history_prev, q, 0);
    bool known = plan_here.y > 0.0 && past.x >= 0.0, followed = plan_here.y >= 0.0;
    keep_moments(here, q, past, known, followed, drawn.a, exposed(drawn.rgb));
#if GUIDING
    Gathered sums = Gathered(texelFetch(sum, p, 0).rgb, texelFetch(share, p, 0).rgb, texelFetch(whole, p, 0).rgb);
    Guided now = guided_light(lines, sums, here, q, plan_here.y > 0.0);
    // What is blurred has no noise: samples that come to it later go on from there.
    if (texelFetch(sampled, p, 0).r == 0.0) {
        now.sums = Gathered(texelFetch(blurred, p, 0).rgb, vec3(1.0), vec3(1.0));
        now.frames = 1.0 / param.guiding_weight;
    }
    keep_average(now);
#endif
}
