#include "tile.glsl"

// A smaller radius blurs nothing.
const float kLeastBlurPx = 0.5;

// How far what is in front of a point may reach it, px; `around_coc` is the texel of `around`.
float front_reach_px(vec4 around_coc, float coc) {
    if (around_coc.x >= coc - 0.05) return 0.0;
    float far_px = coc > around_coc.z - kClear ? around_coc.y : coc;
    return max(-around_coc.x, max(far_px, 0.0));
}
