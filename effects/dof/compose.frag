#version 450 core
#include <pass>
#include "blur.glsl"
#include "levels.glsl"

// Weights of the four texels of half size around a pixel: bilinear, for those that show the pixel's surface.
struct Corners {
    ivec2 texel[4];
    float weight[4];
};

Corners corners_of(ivec2 p, float coc) {
    Corners corners;
    vec2 at = 0.5 * (vec2(p) + 0.5) - 0.5;
    ivec2 base = ivec2(floor(at)), last = (frame.size + 1) / 2 - 1;
    vec2 part = at - vec2(base);
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 step = ivec2(i & 1, i >> 1);
        vec2 linear = mix(1.0 - part, part, vec2(step));
        corners.texel[i] = clamp(base + step, ivec2(0), last);
        float apart = abs(tap_light(corners.texel[i], 1).coc - coc);
        corners.weight[i] = linear.x * linear.y * (max(1.0 - apart, 0.0) + 1e-3 / (1.0 + apart * apart));
        sum += corners.weight[i];
    }
    for (int i = 0; i < 4; ++i) corners.weight[i] /= sum;
    return corners;
}

void main() {
    prepare_outline();
    ivec2 p = ivec2(gl_FragCoord.xy);
    Light own = tap_light(p, 0);
    vec2 center = vec2(p) + 0.5;
    move_rim(center);
    float reach_px = front_reach_px(texelFetch(around, p / kTile, 0), own.coc), radius_px = abs(own.coc);

    Back surface = Back(own.color, 1.0);
    if (radius_px >= 0.5 && radius_px < kFullSizePx) surface = gather_back(center, own.coc, 0);
    Layer over = Layer(vec4(0.0), 0.0);
    if (reach_px >= 0.5 && reach_px <= kFullSizePx) over = gather_front(center, own.coc, reach_px, 0);

    if (radius_px > kFullSizePx - 1.0 || reach_px > kFullSizePx) {
        Corners corners = corners_of(p, own.coc);
        Back coarse_surface = Back(vec4(0.0), 0.0);
        Layer coarse_over = Layer(vec4(0.0), 0.0);
        for (int i = 0; i < 4; ++i) {
            Light b = unpack_light(texelFetch(back, corners.texel[i], 0));
            Light f = unpack_light(texelFetch(front, corners.texel[i], 0));
            coarse_surface.color += corners.weight[i] * b.color;
            coarse_surface.share += corners.weight[i] * b.coc;
            coarse_over.color += corners.weight[i] * f.color;
            coarse_over.opacity += corners.weight[i] * f.coc;
        }
        float coarse = clamp(radius_px - kFullSizePx + 1.0, 0.0, 1.0);
        surface.color = mix(surface.color, coarse_surface.color, coarse);
        surface.share = mix(surface.share, coarse_surface.share, coarse);
        if (reach_px > kFullSizePx) over = coarse_over;
    }
    out_color = over.color + surface.color * (1.0 - over.opacity);
    out_veil = (1.0 - over.opacity) * vec2(1.0, 1.0 - surface.share);
}
