#version 450 core
#include <pass>
#include "drawn.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    ViewLines lines = view_lines();
    Facet here = read_facet(lines, p);
    vec4 plan_here = texelFetch(plan, p, 0);
    float count = here.key == 0u ? 0.0 : plan_here.x;
    Gathered sums = drawn(lines, p, here, count, texelFetch(epoch, p, 0).r);
    out_estimate = vec4(mix(here.light, filled(sums), plan_here.z), count);
}
