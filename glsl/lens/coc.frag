#version 450 core
#include <pass>
#include "coc.glsl"
#include "highlight.glsl"

ivec2 inside(ivec2 p) { return clamp(p, ivec2(0), ivec2(color_size.xy) - 1); }

float coc_at(ivec2 p, float at_infinity_px) {
    float coc = coc_radius_px(texelFetch(depth, inside(p), 0).r, param.focus_distance, at_infinity_px);
    return clamp(coc, -param.max_coc_radius, param.max_coc_radius);
}

// An antialiased pixel at the edge of a small light has the light's colour but may have the background's depth, and would
// throw a large polygon around the light's own. Where all of a pixel's light came across such an edge, it takes the CoC of
// the brightest neighbour on the other side. One or the other: a CoC in between is that of no surface.
float repaired_coc(ivec2 p, float coc, float at_infinity_px) {
    float own_amount = amount(texelFetch(color, p, 0).rgb);
    float darkest = own_amount, brightest = own_amount, other_coc = coc;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            ivec2 q = p + ivec2(x, y);
            float tap_amount = amount(texelFetch(color, inside(q), 0).rgb), tap_coc = coc_at(q, at_infinity_px);
            if (abs(tap_coc - coc) <= 1.0) {
                darkest = min(darkest, tap_amount);
            } else if (tap_amount > brightest) {
                brightest = tap_amount;
                other_coc = tap_coc;
            }
        }
    return own_amount > 1.4 * kHighlight * darkest ? other_coc : coc;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float px_per_mm = float(frame.display_size.x) / param.sensor_width;
    float at_infinity_px = coc_radius_at_infinity_px(param.focus_distance, param.focal_length, param.f_number, px_per_mm,
                                                     LENS_MODEL == LENS_MODEL_THIN);
    float coc = coc_at(p, at_infinity_px);
#if HIGHLIGHT_REPAIR
    coc = repaired_coc(p, coc, at_infinity_px);
#endif
    out_coc = coc;
}
