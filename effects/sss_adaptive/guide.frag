#version 450 core
#include <pass>
#include "guide.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Facet here = read_facet(view_lines(), p);
    Guided after = guided_light(texelFetch(estimate, p, 0).rgb, texelFetch(share, p, 0).rgb, here);
#ifdef HAS_BLURRED
    // What is blurred has no noise: samples that come to it later go on from there.
    if (texelFetch(sampled, p, 0).r == 0.0) {
        after.light = vec4(texelFetch(blurred, p, 0).rgb, 1.0 / param.guiding_weight);
        after.share = vec4(1.0);
    }
#endif
    bool scatters = here.key != 0u;
    out_guided = scatters ? after.light : vec4(0.0);
    out_guided_share = scatters ? after.share : vec4(0.0);
    out_lit = scatters ? after.lit : vec4(0.0);
    out_lit_near = scatters ? after.lit_near : 0.0;
}
