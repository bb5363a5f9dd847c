#version 450 core
#include <pass>

// What many taps read together.
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 n = clamp(texelFetch(normal, at, 0).xyz, -1.0, 1.0);
    out_shape = uvec4(texelFetch(facet, at, 0).r, floatBitsToUint(texelFetch(surface, at, 0).a), packSnorm2x16(n.xy),
                      packSnorm2x16(vec2(n.z, 0.0)));
}
