#version 450 core
#include <pass>
#include <lens/packing.glsl>
#include <lens/own.glsl>

const float kLeastBlurPx = 0.5;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 texel = own_color(p);
    float coc_px = texelFetch(coc, p, 0).r;
    out_light = pack_light(Light(texel, coc_px));
#if SAMPLER == SAMPLER_MIPS
    float share = abs(coc_px) >= kLeastBlurPx ? 1.0 : 0.0;
    out_blurred = share > 0.0 ? texel : vec4(0.0);
    out_blurred_coc = vec4(share, share * coc_px, share * coc_px * coc_px, 0.0);
#endif
}
