#version 450 core
#include <pass>
#include <lens/packing.glsl>
#include <lens/own.glsl>
#include "horizon.glsl"
#ifdef HAS_SURROUND
#include "shine.glsl"
#endif

#ifdef SILHOUETTES
#include "unmix.glsl"
#endif

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 texel = own_color(p);
    float coc_px = texelFetch(lit_coc, p, 0).r;
#ifdef SILHOUETTES
    Unmixed alone = unmixed(p, texel.rgb, coc_px);
    texel.rgb = alone.color;
    out_mixture = alone.kind;
    out_kept = alone.kept;
#endif
#if defined(SHARP)
    out_kept = vec4(0.0);
#endif
#if defined(SILHOUETTES) || defined(HORIZON)
    coc_px = horizon_coc(p, coc_px);
#endif
#ifdef HAS_SURROUND
    vec2 around_amount = texelFetch(surround, p / 8, 0).rg;
    float share = highlight_share(dot(texel.rgb, vec3(1.0)), around_amount, abs(coc_px), vec2(p) + 0.5);
    out_is_highlight = share > 0.0 ? 1.0 : 0.0;
    texel.rgb *= 1.0 - share;
#endif
    out_light = pack_light(Light(texel, coc_px));
}
