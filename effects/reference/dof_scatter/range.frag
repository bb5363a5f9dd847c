#version 450 core
#include <pass>

void main() {
    ivec2 size = ivec2(range_tile_size.xy);
    vec2 largest = vec2(0.0);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) largest = max(largest, texelFetch(range_tile, ivec2(x, y), 0).rg);
    out_range = largest;
}
