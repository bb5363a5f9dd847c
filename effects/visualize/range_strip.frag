#version 450 core
#include <pass>

// In two steps, so that no invocation has more tiles than llvmpipe has iterations.
void main() {
    vec2 range = vec2(3e38, -3e38);
    int faults = 0;
    for (int x = int(gl_FragCoord.x); x < int(range_tile_size.x); x += 64)
        for (int y = 0; y < int(range_tile_size.y); ++y) {
            vec4 tile = texelFetch(range_tile, ivec2(x, y), 0);
            range = vec2(min(range.x, tile.x), max(range.y, tile.y));
            faults |= int(tile.z);
        }
    out_range_strip = vec4(range, float(faults), 0.0);
}
