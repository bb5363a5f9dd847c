#version 450 core
#include <pass>
#include <scattering/lit.glsl>

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 here = texelFetch(surface, p, 0);
    out_lit_pixels = pack(Lit(here.rgb, here.a, texelFetch(facet, p, 0).r));
}
