#version 450 core
#include <pass>
#include "blur.glsl"

void blur_first(Grid grid, ivec2 point, float near_px) {
    Sample a = blur(LIGHT, grid, point, near_px, grid.sign * ivec2(1, 0));
    Sample b = blur(LIGHT, grid, point, near_px, grid.sign * ivec2(-1, 1));
    OUT_A = pack_sample(a);

    float weight = max(a.weight + b.weight, 1e-6), share = b.weight / weight;
    float a_amount = amount(a.color.rgb) * a.weight, b_amount = amount(b.color.rgb) * b.weight;
    float coc = a_amount + b_amount > 0.0 ? mix(a.coc, b.coc, b_amount / (a_amount + b_amount)) : mix(a.coc, b.coc, share);
    OUT_AB = pack_sample(Sample(mix(a.color, b.color, share), coc, 0.5 * weight, mix(a.opacity, b.opacity, 0.5)));
}

void main() {
    OUT_A = uvec4(0u);
    OUT_AB = uvec4(0u);
    Grid grid = make_grid(kSpacing);
    ivec2 point = point_of(grid, ivec2(gl_FragCoord.xy));
    vec4 tile = grids_at(position_of(grid, point));
    if (is_needed(tile)) blur_first(grid, point, tile.x);
}
