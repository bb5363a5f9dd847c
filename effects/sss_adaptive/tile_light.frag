#version 450 core
#include <pass>
#include <luminance.glsl>
#define ALONG_ROWS 0
#include <scattering/cut.glsl>
#include <scattering/profile.glsl>
#include "tile.glsl"

const float kLivelyRadius = 5.0;  // d; Burley's profile has 86 % of its light within

// What a tile holds of what scatters: its range of light; how far light goes on it; how far its blur along columns reaches.
void main() {
    ViewLines lines = view_lines();
    ivec2 corner = kTile * ivec2(gl_FragCoord.xy);
    vec2 light = vec2(1e30, -1.0), kinds = vec2(0.0);
    float radius_px = 0.0, reach_px = 0.0;
    for (int i = 0; i < kTile * kTile; ++i) {
        ivec2 p = corner + ivec2(i % kTile, i / kTile);
        uint key = all(lessThan(p, frame.size)) ? texelFetch(facet, p, 0).r : 0u;
        if (key == 0u) continue;
        vec4 here = texelFetch(surface, p, 0);
        float own = luminance(here.rgb);
        light = vec2(min(light.x, own), max(light.y, own));
        kinds = max(kinds, sampled_ids(key - 1u) ? vec2(1.0, 0.0) : vec2(0.0, 1.0));
        ScatteringProfileRow profile = scattering_profile(key - 1u);
        radius_px = max(radius_px, kLivelyRadius * max(profile.d.r, max(profile.d.g, profile.d.b)) * pixels_per_mm(lines, here.a));
        Cut cut = cut_at(lines, p, here.a);
        float outermost = texelFetch(half_kernel, ivec2(param.blur_samples / 2, profile.index), 0).a;
        reach_px = max(reach_px, max(abs(pixels_to(lines, cut, outermost)), abs(pixels_to(lines, cut, -outermost))));
    }
    out_tile_light = vec4(light, radius_px, reach_px + 1.0);
    out_tile_kinds = kinds;
}
