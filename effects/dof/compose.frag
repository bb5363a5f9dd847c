#version 450 core
#include <pass>
#include "fronts.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#ifdef SILHOUETTES
    Light own = plate_at(p);
#else
    Light own = tap_light(p);
#endif
    vec2 center = vec2(p) + 0.5;
    vec4 around_coc = texelFetch(around, p / kTile, 0);
    float visible_coc = tap_light(p).coc, radius_px = abs(own.coc);
    Front front = front_at(p, own, visible_coc, around_coc);
    bool is_wide = radius_px > kFullSizePx - 1.0;

    if (radius_px >= kLeastBlurPx || front.reach_px >= kLeastBlurPx) prepare_outline_at(center);
    bool is_own = radius_px >= kLeastBlurPx && (radius_px < kFullSizePx || front.is_lost);
    Gathered found = gather(Point(center, own, visible_coc, front.asked_px, front.which, is_own ? radius_px : kNotAsked), around_coc);
    Back surface = found.surface;
    if (is_wide && !front.is_lost) {
        float share = clamp(radius_px - kFullSizePx + 1.0, 0.0, 1.0);
        surface.color = mix(surface.color, front.coarse.surface.color, share);
        surface.share = mix(surface.share, front.coarse.surface.share, share);
    }
    Layer over = whole(front, found.over);
#ifdef HAS_KEPT
    vec4 near = texelFetch(kept, p, 0);
    float covered = max(near.a - over.opacity, 0.0) / max(1.0 - over.opacity, 1e-3), uncovered = 1.0 - covered;
    // Of the pixel's own alpha, what is not that of the surface behind.
    float near_alpha = clamp(texelFetch(color, p, 0).a - (1.0 - near.a) * surface.color.a, 0.0, near.a);
    surface.color = uncovered * surface.color + covered / max(near.a, 1e-3) * vec4(near.rgb, near_alpha);
#else
    const float uncovered = 1.0;
#endif
    out_color = over.color + surface.color * (1.0 - over.opacity);
#ifdef SILHOUETTES
    bool is_hidden = visible_coc < own.coc - kClear;
#else
    const bool is_hidden = false;
#endif
    out_veil = is_hidden ? 1.0 - over.hides : (1.0 - over.opacity) * uncovered * vec2(1.0, 1.0 - surface.share);
}
