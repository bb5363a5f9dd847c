#version 450 core
#include <pass>
#include <aperture.glsl>
#include "mixed.glsl"
#include "order.glsl"
#include "surfel.glsl"

// A highlight outshines its surroundings this many times, and its light, spread over its CoC, still adds this fraction of them.
const float kOutshines = 4.0, kVisible = 0.005;
const float kLeastRadiusPx = 1.5;

// The share of a pixel's light that is its highlight: what lies above the darkest part of its surroundings, fading in so that
// nothing flickers. Visibility samples would miss most of a highlight that few pixels hold.
float highlight_share(float amount, vec2 around_amount, float radius_px) {
    if (radius_px < kLeastRadiusPx) return 0.0;
    float area = make_aperture(param.blades, param.curvature, 0.0).area * radius_px * radius_px;
    float bound = max(around_amount.x, 0.0) * max(kOutshines, kVisible * area);
    if (amount <= bound) return 0.0;
    return smoothstep(1.0, 1.5, amount / max(bound, 1e-30)) * (amount - clamp(around_amount.y, 0.0, amount)) / amount;
}

ivec2 inside(ivec2 p) { return clamp(p, ivec2(0), frame.size - 1); }
vec3 color_inside(ivec2 p) { return texelFetch(color, inside(p), 0).rgb; }
float order_inside(ivec2 p) { return texelFetch(order, inside(p), 0).r; }
float amount(vec3 rgb) { return rgb.r + rgb.g + rgb.b; }

const float kLeastShare = 0.1, kMostShare = 0.7;
const float kContrast = 0.15;  // of two surfaces, below which a mixture cannot be seen
const float kOffLine = 0.03;   // squared distance from the line between both colours, of its length squared

// What antialiasing brought in from across a silhouette would move with the wrong surface. Gives the pixel's light without it.
Mixture mixture_at(ivec2 p, inout vec3 own) {
    Mixture found = Mixture(0.0, ivec2(0));
    bool is_sharp = reach_px(texelFetch(coc, p, 0).r, path_at(p)) < 1.0;
    float own_order = texelFetch(order, p, 0).r, most = kLeastShare;
    vec3 result = own;
    for (int i = 0; i < 9; ++i) {
        ivec2 to = ivec2(i % 3, i / 3) - 1;
        if (inside(p + to) != p + to) continue;
        float across = order_inside(p + to);
        if (is_sharp && across > own_order) continue;  // antialiased in its place
        if (abs(across - own_order) <= kClearPx || abs(order_inside(p - 2 * to) - own_order) > kClearPx) continue;
        bool is_thick = abs(order_inside(p + 2 * to) - across) <= kClearPx;
        vec3 self = color_inside(p - 2 * to), change = self - color_inside(p - 3 * to);
        vec3 difference = color_inside(is_thick ? p + 2 * to : p + to) - self;
        float length_2 = dot(difference, difference);
        if (amount(abs(difference)) < kContrast * (amount(abs(self)) + amount(abs(self + difference)))) continue;
        // Shading that continues as it does inside the surface is not a mixture.
        float share = (dot(own - self, difference) - 2.0 * max(dot(change, difference), 0.0)) / length_2;
        vec3 rest = own - self - share * difference;
        if (share <= most || share > kMostShare || max(dot(rest, rest), dot(change, change)) > kOffLine * length_2) continue;
        most = share;
        found = Mixture(share, to);
        result = max(own - share * difference, min(own, self));
    }
    own = result;
    return found;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 texel = texelFetch(color, p, 0);
    out_mixed = 0u;
#ifdef HAS_SENDS
    bool is_sent = texelFetch(sends, p / 16, 0).g > 0.0;
#else
    const bool is_sent = true;
#endif
#ifndef HAS_SECOND
    if (is_sent && texelFetch(reach, p / 16, 0).r >= 1.0) out_mixed = pack_mixture(mixture_at(p, texel.rgb));
#endif
    float share = highlight_share(amount(texel.rgb), texelFetch(surround, p / 8, 0).rg, abs(texelFetch(coc, p, 0).r));
    out_highlight = vec4(share * texel.rgb, share);
    out_light = vec4((1.0 - share) * texel.rgb, texel.a);
}
