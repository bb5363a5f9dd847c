#version 450 core
#include <pass>
#include "guide.glsl"

// What is blurred has no noise: samples that come to it later go on from there.
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Facet here = read_facet(view_lines(), p);
    out_guided = vec4(0.0);
    out_lit = vec4(0.0);
    out_lit_near = 0.0;
    if (here.key == 0u) return;
    out_guided = guided_light(texelFetch(estimate, p, 0).rgb, here, out_lit, out_lit_near);
    if (texelFetch(sampled, p, 0).r == 0.0) out_guided = vec4(texelFetch(blurred, p, 0).rgb, 1.0 / param.guiding_weight);
}
