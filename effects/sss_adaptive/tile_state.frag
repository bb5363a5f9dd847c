#version 450 core
#include <pass>
#include <scattering/lines.glsl>
#include <scattering/lit.glsl>
#include <scattering/profile.glsl>
#include "tile.glsl"

// Whether anything in a tile changed since the frame before, and how far the blurs of its pixels reach, px.
void main() {
    ViewLines lines = view_lines();
    ivec2 corner = kTile * ivec2(gl_FragCoord.xy);
    bool changed = !frame.history_valid || texelFetch(settings, ivec2(0), 0).r != texelFetch(settings_prev, ivec2(0), 0).r;
    float nearest_m = 3e38, steepest = 0.0, outermost_mm = 0.0;
    uint known_key = 0u;
    for (int i = 0; i < kTile * kTile; ++i) {
        ivec2 p = corner + ivec2(i % kTile, i / kTile);
        if (any(greaterThanEqual(p, frame.size))) continue;
        uvec4 texel = texelFetch(lit_pixels, p, 0);
        changed = changed || texel != texelFetch(lit_pixels_prev, p, 0);
        Lit here = unpack(texel);
        if (here.key == 0u) continue;
        nearest_m = min(nearest_m, here.depth_m);
        vec2 slopes = abs(unpackHalf2x16(texelFetch(facet, p, 0).g));
        steepest = max(steepest, max(slopes.x, slopes.y));
        if (here.key == known_key) continue;
        known_key = here.key;
        int index = scattering_profile(here.key - 1u).index;
        outermost_mm = max(outermost_mm, texelFetch(half_kernel, ivec2(param.blur_samples / 2, index), 0).a);
    }
    // Steps along a slope are at most as long across the view as the line to the tile is.
    float across_mm = outermost_mm * length(view_line(lines, vec2(corner) + 0.5 * float(kTile)));
    float depth_mm = param.world_unit * nearest_m;
    float reach_px = across_mm / (lines.slope.x * max(depth_mm - across_mm * steepest, 0.05 * depth_mm)) + 1.0;
    out_tile_state = vec2(changed ? 1.0 : 0.0, known_key > 0u ? reach_px : 0.0);
}
