#version 450 core
#include <pass>

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_light = texelFetch(facet, p, 0).r == 0u ? vec4(0.0) : vec4(texelFetch(surface, p, 0).rgb, 1.0);
}
