#version 450 core
#include <pass>
#include "plan.glsl"

void main() {
    ViewLines lines = view_lines();
    Facet here = read_facet(lines, ivec2(gl_FragCoord.xy));
    out_plan = here.key == 0u ? vec4(0.0) : planned(lines, here);
}
