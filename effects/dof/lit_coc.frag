#version 450 core
#include <pass>
#include <lens/coc_of.glsl>

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#ifdef HAS_COC
    out_lit_coc = texelFetch(coc, p, 0).r;
#else
    out_lit_coc = coc_of(texelFetch(depth, p, 0).r, lens_at_infinity_px());
#endif
}
