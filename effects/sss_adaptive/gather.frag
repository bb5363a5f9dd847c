#version 450 core
#include <pass>
#include "drawn.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    ViewLines lines = view_lines();
    Facet here = read_facet(lines, p);
    vec4 plan_here = texelFetch(plan, p, 0);
    float count = here.key == 0u ? 0.0 : plan_here.x;
    Drawn drawn = drawn_light(lines, p, here, count, texelFetch(epoch, p, 0).r, plan_here.z);
    out_estimate = vec4(drawn.light, drawn.count);
    out_share = vec4(drawn.share, 0.0);
}
