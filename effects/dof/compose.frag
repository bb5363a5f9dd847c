#version 450 core
#include <pass>
#include "blur.glsl"
#include "levels.glsl"

// Adds up the four texels of half size around a pixel: bilinear, of those that show the pixel's surface.
void take_half_size(ivec2 p, float coc, out Layer over, out Back surface) {
    vec2 at = 0.5 * (vec2(p) + 0.5) - 0.5;
    ivec2 base = ivec2(floor(at)), last = (frame.size + 1) / 2 - 1;
    vec2 part = at - vec2(base);
    over = Layer(vec4(0.0), 0.0);
    surface = Back(vec4(0.0), 0.0);
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1), texel = clamp(base + corner, ivec2(0), last);
        Light b = unpack_light(texelFetch(back, texel, 0)), f = unpack_light(texelFetch(front, texel, 0));
        if (b.coc < 0.0) continue;  // of a tile in focus
        float apart = abs(tap_light(texel, 1).coc - coc);
        vec2 linear = mix(1.0 - part, part, vec2(corner));
        float weight = linear.x * linear.y * (max(1.0 - apart, 0.0) + 1e-3 / (1.0 + apart * apart));
        sum += weight;
        surface.color += weight * b.color;
        surface.share += weight * b.coc;
        over.color += weight * f.color;
        over.opacity += weight * f.coc;
    }
    over.color /= sum;
    over.opacity /= sum;
    surface.color /= sum;
    surface.share /= sum;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Light own = tap_light(p, 0);
    vec2 center = vec2(p) + 0.5;
    float reach_px = front_reach_px(texelFetch(around, p / kTile, 0), own.coc), radius_px = abs(own.coc);

    if (radius_px >= kLeastBlurPx || reach_px >= kLeastBlurPx) prepare_outline_at(center);
    Back surface = Back(own.color, 1.0);
    if (radius_px >= kLeastBlurPx && radius_px < kFullSizePx) surface = gather_back(center, own, 0);
    Layer over = Layer(vec4(0.0), 0.0);
    if (reach_px >= kLeastBlurPx && reach_px <= kFullSizePx) over = gather_front(center, own.coc, reach_px, 0);

    if (radius_px > kFullSizePx - 1.0 || reach_px > kFullSizePx) {
        Layer coarse_over;
        Back coarse_surface;
        take_half_size(p, own.coc, coarse_over, coarse_surface);
        float coarse = clamp(radius_px - kFullSizePx + 1.0, 0.0, 1.0);
        surface.color = mix(surface.color, coarse_surface.color, coarse);
        surface.share = mix(surface.share, coarse_surface.share, coarse);
        if (reach_px > kFullSizePx) over = coarse_over;
    }
    out_color = over.color + surface.color * (1.0 - over.opacity);
    out_veil = (1.0 - over.opacity) * vec2(1.0, 1.0 - surface.share);
}
