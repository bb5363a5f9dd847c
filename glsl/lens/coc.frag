#version 450 core
#include <pass>
#include "lens.glsl"

layout(location = 0) flat in vec4 lens;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#ifdef SHARES_PIXELS
    out_coc = coc_at(p, lens.x);
#else
    out_coc = clamp(coc_radius_px(texelFetch(depth, p, 0).r, lens.y, lens.x), lens.z, lens.w);
#endif
}
