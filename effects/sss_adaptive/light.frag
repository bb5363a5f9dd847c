#version 450 core
#include <pass>
#include "mark.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec3 light_here = texelFetch(surface, p, 0).rgb;
    float mark = mark_of(texelFetch(facet, p, 0).r);
    out_light = mark > 0.0 ? vec4(light_here, mark) : vec4(0.0);
}
