#version 450 core
#include <pass>
#include <color_luminance.glsl>
#include "tile.glsl"

// Mean luminance of the light on a tile, with 0 for what does not scatter, and the share of the tile that scatters.
void main() {
    ivec2 corner = kTile * ivec2(gl_FragCoord.xy);
    vec2 sum = vec2(0.0);
    for (int i = 0; i < kTile * kTile; ++i) {
        ivec2 p = corner + ivec2(i % kTile, i / kTile);
        if (any(greaterThanEqual(p, frame.size)) || texelFetch(facet, p, 0).r == 0u) continue;
        sum += vec2(max(color_luminance(texelFetch(surface, p, 0).rgb), 0.0), 1.0);
    }
    out_tile_light = sum / float(kTile * kTile);
}
