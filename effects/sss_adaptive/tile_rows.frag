#version 450 core
#include <pass>
#include "tile.glsl"

// Whether a blur along columns reads the tile: of its column, as far as that tile's taps reach.
void main() {
    ivec2 tile = ivec2(gl_FragCoord.xy);
    vec2 kinds = texelFetch(tile_kinds, tile, 0).rg;
    bool needed = false;
    for (int y = 0; y < int(tile_class_size.y); ++y) {
        ivec2 there = ivec2(tile.x, y);
        float reach_px = texelFetch(tile_light, there, 0).a, away_px = float(kTile * (abs(y - tile.y) - 1) + 1);
        needed = needed || (texelFetch(tile_class, there, 0).g > 0.0 && away_px <= reach_px);
    }
    out_tile_rows = needed && kinds.x + kinds.y > 0.0 ? 1.0 : 0.0;
}
