#version 450 core
#include <pass>
#include "scattered.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Scattered here = scattered_at(p);
    vec2 seen = texelFetch(veil, p, 0).rg;
    float through = seen_before(here, seen.x) + here.behind * seen.y;
    out_color = vec4(through * here.density * light_of_source, 0.0);
}
