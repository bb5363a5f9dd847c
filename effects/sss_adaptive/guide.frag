#version 450 core
#include <pass>
#include "guide.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Facet here = read_facet(view_lines(), p);
    Guided after = guided_light(texelFetch(estimate, p, 0).rgb, texelFetch(share, p, 0).rgb, here);
    bool scatters = here.key != 0u;
    out_guided = scatters ? after.light : vec4(0.0);
    out_guided_share = scatters ? after.share : vec4(0.0);
    out_lit = scatters ? after.lit : vec4(0.0);
    out_lit_near = scatters ? after.lit_near : 0.0;
}
