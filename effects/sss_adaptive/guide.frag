#version 450 core
#include <pass>
#include "guide.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Facet here = read_facet(view_lines(), p);
    out_guided = vec4(0.0);
    out_lit = vec4(0.0);
    out_lit_near = 0.0;
    if (here.key != 0u) out_guided = guided_light(texelFetch(estimate, p, 0).rgb, here, out_lit, out_lit_near);
}
