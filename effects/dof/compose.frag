#version 450 core
#include <pass>
#include "blur.glsl"

// What the four texels of half size around a pixel have of it.
struct Coarse {
    Layer over;
    Back surface;
    float likeness;  // share of the texels, by bilinear weight, that show the pixel's surface
};

Coarse take_half_size(ivec2 p, float coc) {
    vec2 at = 0.5 * (vec2(p) + 0.5) - 0.5;
    ivec2 corner = ivec2(floor(at)), last = (frame.size + 1) / 2 - 1;
    vec2 part = at - vec2(corner);
    Coarse coarse = Coarse(kNothing, Back(vec4(0.0), 0.0), 0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 to = ivec2(i & 1, i >> 1), texel = clamp(corner + to, ivec2(0), last);
        Light b = unpack_light(texelFetch(back, texel, 0)), f = unpack_light(texelFetch(front, texel, 0));
        if (b.coc < 0.0) continue;  // of a tile in focus
        vec2 linear = mix(1.0 - part, part, vec2(to));
        float texel_coc = unpack_light(texelFetch(plate_half, texel, 0)).coc;
        float weight = linear.x * linear.y * max(1.0 - abs(texel_coc - coc), 0.0);
        coarse.likeness += weight;
        coarse.surface.color += weight * b.color;
        coarse.surface.share += weight * b.coc;
        coarse.over.color += weight * f.color;
        coarse.over.opacity += weight * f.coc;
        coarse.over.hides += weight * texelFetch(hides, texel, 0).rg;
    }
    float scale = 1.0 / max(coarse.likeness, 1e-6);
    coarse.over = Layer(coarse.over.color * scale, coarse.over.opacity * scale, coarse.over.hides * scale);
    coarse.surface = Back(coarse.surface.color * scale, coarse.surface.share * scale);
    return coarse;
}

// Where a thin thing is lost at half size, its pixels are gathered one by one.
const float kLeastLikeness = 0.6;

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
    float reach_px = front_reach_px(around_coc, own.coc, visible_coc);
    bool is_wide = radius_px > kFullSizePx - 1.0, is_reached_far = reach_px > kFullSizePx;
    Coarse coarse = take_half_size(p, own.coc);
    bool is_lost = coarse.likeness < kLeastLikeness;

    if (radius_px >= kLeastBlurPx || reach_px >= kLeastBlurPx) prepare_outline_at(center);
    bool is_own = radius_px >= kLeastBlurPx && (radius_px < kFullSizePx || is_lost);
    bool is_all = reach_px >= kLeastBlurPx && (!is_reached_far || is_lost), is_narrow = is_reached_far && !is_all && texelFetch(lit, p / kTile, 0).g > 0.5;
    Gathered found = gather(Point(center, own, visible_coc, is_all ? reach_px : is_narrow ? kFullSizePx : kNotAsked,
                                  is_narrow ? kFullSizePx : widest_radius_px(around_coc), is_narrow ? kNarrow : kAll,
                                  is_own ? radius_px : kNotAsked), around_coc);
    Back surface = found.surface;
    if (is_wide && !is_lost) {
        float share = clamp(radius_px - kFullSizePx + 1.0, 0.0, 1.0);
        surface.color = mix(surface.color, coarse.surface.color, share);
        surface.share = mix(surface.share, coarse.surface.share, share);
    }
    Layer over = found.over;
    if (is_reached_far && !is_all) over = both(over, coarse.over);
    out_color = over.color + surface.color * (1.0 - over.opacity);
    bool is_hidden = visible_coc < own.coc - kClear;
    out_veil = is_hidden ? 1.0 - over.hides : (1.0 - over.opacity) * vec2(1.0, 1.0 - surface.share);
}
