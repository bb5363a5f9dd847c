#version 450 core
#include <pass>
#include "highlight.glsl"
#include "lens.glsl"

ivec2 inside(ivec2 p) { return clamp(p, ivec2(0), ivec2(color_size.xy) - 1); }

const float kOutshinesTile = 3.0;
const float kLeastShare = 0.02;  // of the light: less of it cannot be seen in a blur

struct Tap {
    float amount, coc;
    bool is_shared;  // by layers of the capture, which leave nothing to repair
};

Tap tap_at(ivec2 p, float at_infinity_px) {
#ifdef SHARES_PIXELS
    Surface surface = surface_at(p, at_infinity_px);
    return Tap(amount(surface.is_shared ? surface.color.rgb : texelFetch(color, p, 0).rgb), surface.coc, surface.is_shared);
#else
    return Tap(amount(texelFetch(color, p, 0).rgb), coc_at(p, at_infinity_px), false);
#endif
}

// An antialiased pixel at the edge of a small light has the light's colour but may have the background's depth, and would
// throw a large polygon around the light's own. Where all of a pixel's light came across such an edge, from what outshines the
// tile, it takes the CoC of the brightest neighbour on the other side. One or the other: a CoC in between is that of no surface.
float repaired_coc(ivec2 p, float at_infinity_px) {
    Tap own = tap_at(p, at_infinity_px);
    if (own.is_shared) return own.coc;
    float darkest = own.amount, brightest = own.amount, other_coc = own.coc;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            Tap tap = tap_at(inside(p + ivec2(x, y)), at_infinity_px);
            if (abs(tap.coc - own.coc) <= kOneSurfacePx) {
                darkest = min(darkest, tap.amount);
            } else if (tap.amount > brightest) {
                brightest = tap.amount;
                other_coc = tap.coc;
            }
        }
    float mean_amount = texelFetch(coc_step, p / kRepairTile, 0).g;
    return own.amount > max(1.4 * kHighlight * darkest, kLeastShare * brightest) && brightest > kOutshinesTile * mean_amount ? other_coc : own.coc;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_coc = repaired_coc(p, lens_at_infinity_px());
}
