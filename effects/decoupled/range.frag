#version 450 core
#include <pass>

void main() {
    vec2 all = vec2(1e9, -1e9);
    for (int y = 0; y < int(range_tile_size.y); ++y)
        for (int x = 0; x < int(range_tile_size.x); ++x) {
            vec2 tile = texelFetch(range_tile, ivec2(x, y), 0).rg;
            all = vec2(min(all.x, tile.x), max(all.y, tile.y));
        }
    out_range = all;
}
