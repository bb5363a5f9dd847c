#include "tile.glsl"

// A smaller radius blurs nothing.
const float kLeastBlurPx = 0.5;

// How far what is in front of a point may reach it, px; `around_coc` is the texel of `around`.
float front_reach_px(vec4 around_coc, float coc) {
    if (around_coc.x >= coc - 0.05) return 0.0;
    float far_px = coc > around_coc.z - kClear ? around_coc.y : coc;
    return max(-around_coc.x, max(far_px, 0.0));
}

// The same at a point that shows a surface of `visible_coc`, which may hide that of `coc`.
float front_reach_px(vec4 around_coc, float coc, float visible_coc) {
    float reach_px = front_reach_px(around_coc, coc);
    return visible_coc < coc - kClear ? max(reach_px, max(abs(visible_coc), front_reach_px(around_coc, visible_coc))) : reach_px;
}

// Of all that reaches a point.
float widest_radius_px(vec4 around_coc) { return max(-around_coc.x, around_coc.w); }
