#version 450 core
#include <pass>
#define UNDER LIGHT
#include "blur.glsl"

uvec4 blur_second(Grid grid, ivec2 point, float near_px) {
    Sample one = blur(A, grid, point, near_px, grid.sign * ivec2(-1, 1));
    Sample two = blur(AB, grid, point, near_px, grid.sign * ivec2(0, -1));
    Sample centre = unpack_sample(texelFetch(LIGHT, ivec2(gl_FragCoord.xy), 0));

    // Each rhombus has a quarter of the point in its corner: together three of four.
    float reach = abs(centre.coc) / kSpacing;
    float missing = reach >= 1.0 ? 0.25 / (reach * reach) : 0.0;
    vec3 weights = vec3(one.weight, 2.0 * two.weight, missing * centre.weight * (1.0 - one.opacity / 3.0 - two.opacity / 1.5));
    float sum = weights.x + weights.y + weights.z;
    vec4 color = (weights.x * one.color + weights.y * two.color + weights.z * centre.color) / max(sum, 1e-6);
    return pack_sample(Sample(color, centre.coc, sum / (3.0 + missing), (one.opacity + 2.0 * two.opacity) / 3.0));
}

void main() {
    OUT = uvec4(0u);
    Grid grid = make_grid(kSpacing);
    ivec2 point = point_of(grid, ivec2(gl_FragCoord.xy));
    vec4 tile = grids_at(position_of(grid, point));
    if (is_needed(tile)) OUT = blur_second(grid, point, tile.x);
}
