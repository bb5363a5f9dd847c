#version 450 core
#include <pass>
#include "tile.glsl"

layout(local_size_x = 16, local_size_y = 16) in;  // a tile each

void main() {
    ivec2 tile = ivec2(gl_GlobalInvocationID.xy), corner = kTile * tile, end = min(corner + kTile, frame.size);
    if (any(greaterThanEqual(corner, frame.size))) return;
    uint count = 0u;
    vec2 coc_px = texelFetch(tile_coc, tile, 0).rg;
    int shining_end = max(-coc_px.x, coc_px.y) >= kLeastHighlightRadiusPx ? end.y : corner.y;
    for (int y = corner.y; y < shining_end; ++y)
        for (int x = corner.x; x < end.x; ++x)
            if (texelFetch(is_highlight, ivec2(x, y), 0).r > 0.5) ++count;
#ifdef HAS_HIDDEN_HIGHLIGHT
    int hiding_end = texelFetch(patched, tile, 0).r > 0.5 ? end.y : corner.y;
    for (int y = corner.y; y < hiding_end; ++y)
        for (int x = corner.x; x < end.x; ++x)
            if (texelFetch(hidden_highlight, ivec2(x, y), 0).a > 0.5) ++count;
#endif
    tile_count[tile.y * tiles_in_a_row() + tile.x] = count;
}
