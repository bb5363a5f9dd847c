#version 450 core
#include <pass>
#include "plan.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), q;
    bool inside = past_pixel(q);
    ViewLines lines = view_lines();
    Facet here = read_facet(lines, p);
    out_plan = vec4(0.0);
    if (here.key == 0u) return;
    Plan now = planned(lines, here, inside, texelFetch(history_prev, q, 0), texelFetch(epoch_prev, q, 0).r);
    out_plan = vec4(now.count, now.known ? 1.0 : 0.0, now.scattered, now.wanted);
}
