#version 450 core
#include <pass>
#include "highlights.glsl"
#include "tile.glsl"

layout(local_size_x = 16, local_size_y = 16) in;  // a tile each

void main() {
    ivec2 tile = ivec2(gl_GlobalInvocationID.xy), corner = kTile * tile, end = min(corner + kTile, frame.size);
    if (any(greaterThanEqual(corner, frame.size))) return;
    int number = tile.y * tiles_in_a_row() + tile.x;
    if (tile_count[number] == 0u) return;
    uint next = tile_first[number];
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x) {
            ivec2 p = ivec2(x, y);
            if (texelFetch(is_highlight, p, 0).r > 0.5) highlight_list[next++] = place_of(p);
#ifdef HAS_HIDDEN_HIGHLIGHT
            if (texelFetch(hidden_highlight, p, 0).a > 0.5) highlight_list[next++] = place_of(p) | kHidden;
#endif
        }
}
