#version 450 core
#include <pass>
#include <color_luminance.glsl>
#include <hash.glsl>
#include <scattering/lines.glsl>
#include <scattering/profile.glsl>
#include "tile.glsl"

// What there is on a tile: its mean light; whether anything of it changed since the frame before; how far the blurs of its pixels
// reach, px.
void main() {
    ivec2 tile = ivec2(gl_FragCoord.xy), corner = kTile * tile;
    int pixels = texelFetch(scatters, tile, 0).r > 0.0 ? kTile * kTile : 0;
    float nearest_m = 3e38, steepest = 0.0, outermost_mm = 0.0;
    vec2 light_and_share = vec2(0.0);
    uint known_key = 0u;
    uvec3 hash = uvec3(0u);
    for (int i = 0; i < pixels; ++i) {
        ivec2 p = corner + ivec2(i % kTile, i / kTile);
        if (any(greaterThanEqual(p, frame.size))) continue;
        vec4 here = texelFetch(surface, p, 0);
        uvec2 key_and_slopes = texelFetch(facet, p, 0).rg;
        uint key = key_and_slopes.r;
        hash = pcg3d(hash ^ floatBitsToUint(here.rgb));
        hash = pcg3d(hash ^ uvec3(floatBitsToUint(here.a), key_and_slopes));
        if (key == 0u) continue;
        light_and_share += vec2(max(color_luminance(here.rgb), 0.0), 1.0);
        nearest_m = min(nearest_m, here.a);
        vec2 slopes = abs(unpackHalf2x16(key_and_slopes.g));
        steepest = max(steepest, max(slopes.x, slopes.y));
        if (key == known_key) continue;
        known_key = key;
#if GUIDING
        int index = scattering_profile(key - 1u).index;
        outermost_mm = max(outermost_mm, texelFetch(half_kernel, ivec2(param.blur_samples / 2, index), 0).a);
#endif
    }
#if TARGET == TARGET_RELATIVE
    out_tile_light = light_and_share / float(kTile * kTile);
#endif
#if GUIDING
    ViewLines lines = view_lines();
    bool same = frame.history_valid && texelFetch(settings, ivec2(0), 0).r == texelFetch(settings_prev, ivec2(0), 0).r &&
        texelFetch(tile_hash_prev, tile, 0).rg == hash.xy;
    out_tile_hash = hash.xy;
    // Steps along a slope are at most as long across the view as the line to the tile is.
    float across_mm = outermost_mm * length(view_line(lines, vec2(corner) + 0.5 * float(kTile)));
    float depth_mm = param.world_unit * nearest_m;
    float reach_px = across_mm / (lines.slope.x * max(depth_mm - across_mm * steepest, 0.05 * depth_mm)) + 1.0;
    out_tile_state = vec2(same ? 0.0 : 1.0, known_key > 0u ? reach_px : 0.0);
#endif
}
