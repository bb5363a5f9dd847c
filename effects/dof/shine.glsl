// Highlights: lights that are drawn one by one.
#include "outline.glsl"
#include "tile.glsl"

// A highlight outshines its surroundings this many times, and its light, spread over its CoC, still adds this fraction of them.
const float kShines = 4.0, kVisible = 0.02;
const float kSurroundPx = 40.0 * 40.0;  // pixels of the surroundings, as surround.frag takes them

// The share of a pixel's light that is its highlight: what lies above the darkest part of its surroundings, fading in so that
// nothing flickers.
float highlight_share(float amount, vec2 around_amount, float radius_px, vec2 pixel) {
    float bound = max(around_amount.x, 0.0) * kShines;
    if (radius_px < kLeastHighlightRadiusPx || amount <= bound) return 0.0;
    prepare_outline_at(pixel);
    // Of the surroundings without the pixel itself: a lone lamp would outgrow its own bound where its disc is as large as they are.
    float others = max(around_amount.x - amount / kSurroundPx, max(around_amount.y, 0.0));
    bound = max(bound, others * kVisible * spread_area(radius_px));
    if (amount <= bound) return 0.0;
    return smoothstep(1.0, 2.0, amount / max(bound, 1e-30)) * (amount - clamp(around_amount.y, 0.0, amount)) / amount;
}
