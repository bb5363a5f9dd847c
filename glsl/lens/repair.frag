#version 450 core
#include <pass>
#include "highlight.glsl"
#include "lens.glsl"

ivec2 inside(ivec2 p) { return clamp(p, ivec2(0), ivec2(color_size.xy) - 1); }

const float kOutshinesTile = 3.0;
const float kLeastShare = 0.02;  // of the light: less of it cannot be seen in a blur

// An antialiased pixel at the edge of a small light has the light's colour but may have the background's depth, and would
// throw a large polygon around the light's own. Where all of a pixel's light came across such an edge, from what outshines the
// tile, it takes the CoC of the brightest neighbour on the other side. One or the other: a CoC in between is that of no surface.
float repaired_coc(ivec2 p, float coc, float at_infinity_px) {
    float own_amount = amount(texelFetch(color, p, 0).rgb);
    float darkest = own_amount, brightest = own_amount, other_coc = coc;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            ivec2 q = p + ivec2(x, y);
            float tap_amount = amount(texelFetch(color, inside(q), 0).rgb), tap_coc = coc_at(inside(q), at_infinity_px);
            if (abs(tap_coc - coc) <= kOneSurfacePx) {
                darkest = min(darkest, tap_amount);
            } else if (tap_amount > brightest) {
                brightest = tap_amount;
                other_coc = tap_coc;
            }
        }
    float mean_amount = texelFetch(coc_step, p / kRepairTile, 0).g;
    return own_amount > max(1.4 * kHighlight * darkest, kLeastShare * brightest) && brightest > kOutshinesTile * mean_amount ? other_coc : coc;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float at_infinity_px = lens_at_infinity_px();
    out_coc = repaired_coc(p, coc_at(p, at_infinity_px), at_infinity_px);
}
