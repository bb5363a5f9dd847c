#version 450 core
#include <pass>
#include <lens/packing.glsl>
#include <lens/highlight.glsl>
#include "tile.glsl"
#include "grid.glsl"
#include "sample.glsl"

const int kSide = FINE == 1 ? 3 : 5, kPixels = kSide * kSide;

ivec2 offset_of(int pixel) { return ivec2(pixel % kSide, pixel / kSide) - kSide / 2; }

// A point takes the light of one surface around it, the one that gives it most, and the share of the pixels that show it.
uvec4 resample(Grid grid, vec2 position) {
    ivec2 middle = ivec2(floor(position)), last = frame.size - 1;
    float most = -1.0, coc = 0.0;
    for (int pixel = 0; pixel < kPixels; ++pixel) {
        ivec2 q = middle + offset_of(pixel);
        float share = share_at(coordinates_of(grid, vec2(q) + 0.5 - position));
        if (share <= 0.0 || !is_in(q, frame.size)) continue;
        Light tap = unpack_light(texelFetch(light, q, 0));
        if (share * (amount(tap.color.rgb) + 1e-4) > most) {
            most = share * (amount(tap.color.rgb) + 1e-4);
            coc = tap.coc;
        }
    }
    if (most < 0.0) return uvec4(0u);

    vec4 color = vec4(0.0);
    float coc_sum = 0.0, weight = 0.0;
    for (int pixel = 0; pixel < kPixels; ++pixel) {
        ivec2 q = middle + offset_of(pixel);
        float share = share_at(coordinates_of(grid, vec2(q) + 0.5 - position));
        if (share <= 0.0 || !is_in(q, frame.size)) continue;
        Light tap = unpack_light(texelFetch(light, q, 0));
        share *= clamp(2.0 - abs(tap.coc - coc), 0.0, 1.0);
        color += share * tap.color;
        coc_sum += share * tap.coc;
        weight += share;
    }
    return pack_sample(Sample(color / weight, coc_sum / weight, weight / (kCell * kSpacing * kSpacing), 0.0));
}

void main() {
    Grid grid = make_grid(kSpacing);
    vec2 position = position_of(grid, point_of(grid, ivec2(gl_FragCoord.xy)));
    OUT = uvec4(0u);
    if (is_needed(grids_at(position))) OUT = resample(grid, position);
}
