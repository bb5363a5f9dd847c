#include "reach.glsl"

bool is_blurred(ivec2 tile) {
    vec2 own = texelFetch(tile_coc, tile, 0).rg;
    float reach_px = front_reach_px(texelFetch(around, tile, 0), own.y);
    return max(max(-own.x, own.y), reach_px) >= kLeastBlurPx;
}
