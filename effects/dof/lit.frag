#version 450 core
#include <pass>
#include "reach.glsl"
#include "levels.glsl"

// A blur takes light from a tile if it reaches the tile, or the tile beside it with the outermost texels of a coarse level.
void main() {
    ivec2 last = ivec2(around_size.xy) - 1, p = ivec2(gl_FragCoord.xy);
    float widest_px = 0.0;
    bool has_narrow_blurs = false;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            ivec2 tile = clamp(p + ivec2(x, y), ivec2(0), last);
            vec4 around_coc = texelFetch(around, tile, 0);
            widest_px = max(widest_px, max(-around_coc.x, around_coc.w));
            vec2 range_px = texelFetch(tile_coc, tile, 0).rg;
            has_narrow_blurs = has_narrow_blurs || range_px.x < kFullSizePx && range_px.y > -kFullSizePx;
        }
    out_lit = vec2(widest_px >= kLeastBlurPx ? 1.0 : 0.0, has_narrow_blurs ? 1.0 : 0.0);
}
