#version 450 core
#include <pass>
#include "past.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), q;
    past_pixel(q);
    vec4 planned = texelFetch(plan, p, 0);
    out_age = texelFetch(facet, p, 0).r != 0u ? (planned.y > 0.0 ? texelFetch(age_prev, q, 0).r : 0.0) + 1.0 : 0.0;
}
