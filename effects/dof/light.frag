#version 450 core
#include <pass>
#include <lens/packing.glsl>
#ifdef HAS_SURROUND
#include "outline.glsl"
#include "tile.glsl"

// A highlight outshines its surroundings this many times, and its light, spread over its CoC, still adds this fraction of them.
const float kOutshines = 4.0, kVisible = 0.02;

// The share of a pixel's light that is its highlight: what lies above the darkest part of its surroundings, fading in so that
// nothing flickers.
float highlight_share(float amount, vec2 around_amount, float radius_px, vec2 pixel) {
    float bound = max(around_amount.x, 0.0) * kOutshines;
    if (radius_px < kLeastHighlightRadiusPx || amount <= bound) return 0.0;
    prepare_outline_at(pixel);
    bound = max(bound, max(around_amount.x, 0.0) * kVisible * spread_area(radius_px));
    if (amount <= bound) return 0.0;
    return smoothstep(1.0, 2.0, amount / max(bound, 1e-30)) * (amount - clamp(around_amount.y, 0.0, amount)) / amount;
}
#endif

#ifdef SILHOUETTES
#include "unmix.glsl"
#endif

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 texel = texelFetch(color, p, 0);
    float coc_px = texelFetch(coc, p, 0).r;
#ifdef SILHOUETTES
    texel.rgb = unmixed(p, texel.rgb, coc_px);
#endif
#ifdef HAS_SURROUND
    vec2 around_amount = texelFetch(surround, p / 8, 0).rg;
    float share = highlight_share(dot(texel.rgb, vec3(1.0)), around_amount, abs(coc_px), vec2(p) + 0.5);
    out_is_highlight = share > 0.0 ? 1.0 : 0.0;
    texel.rgb *= 1.0 - share;
#endif
    out_light = pack_light(Light(texel, coc_px));
}
