#version 450 core
#include <pass>
#include "tile.glsl"

const int kMostTiles = 8;

// Range of the light that scatters into a tile, over its largest.
void main() {
    ivec2 tile = ivec2(gl_FragCoord.xy);
    float radius_px = texelFetch(tile_light, tile, 0).b;
    int reach = clamp(int(ceil(radius_px / float(kTile))), 1, kMostTiles);
    ivec2 low = max(tile - reach, ivec2(0)), high = min(tile + reach, ivec2(tile_light_size.xy) - 1);
    vec2 light = vec2(1e30, -1.0);
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
            vec2 there = texelFetch(tile_light, ivec2(x, y), 0).rg;
            light = vec2(min(light.x, there.x), max(light.y, there.y));
        }
    out_tile_range = light.y > 0.0 ? clamp((light.y - light.x) / light.y, 0.0, 1.0) : 0.0;
}
