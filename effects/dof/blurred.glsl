#include "reach.glsl"

bool is_blurred(ivec2 tile) {
    vec2 own = texelFetch(tile_coc, tile, 0).rg;
    float reach_px = front_reach_px(texelFetch(around, tile, 0), own.y);
    return max(max(-own.x, own.y), reach_px) >= kLeastBlurPx;
}

// Whether one surface clearly lies in front of another within reach.
bool has_silhouettes(ivec2 tile) {
    vec4 around_coc = texelFetch(around, tile, 0);
    return around_coc.w - around_coc.x > kClear;
}
