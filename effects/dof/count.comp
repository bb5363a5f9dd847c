#version 450 core
#include <pass>
#include "tile.glsl"

layout(local_size_x = 16) in;  // a row of the tile each

shared uint sums[kTile];

void main() {
    ivec2 tile = ivec2(gl_WorkGroupID.xy), p = kTile * tile + ivec2(0, gl_LocalInvocationID.x);
    uint count = 0u;
    vec2 coc_px = texelFetch(tile_coc, tile, 0).rg;
    bool may_shine = p.y < frame.size.y && max(-coc_px.x, coc_px.y) >= kLeastHighlightRadiusPx;
#ifdef HAS_HIDDEN_HIGHLIGHT
    int hiding = p.y < frame.size.y && texelFetch(patched, tile, 0).r > 0.5 ? min(kTile, frame.size.x - p.x) : 0;
    for (int i = 0; i < hiding; ++i)
        if (texelFetch(hidden_highlight, p + ivec2(i, 0), 0).a > 0.5) ++count;
#endif
    int columns = may_shine ? min(kTile, frame.size.x - p.x) : 0;
    for (int i = 0; i < columns; ++i)
        if (texelFetch(is_highlight, p + ivec2(i, 0), 0).r > 0.5) ++count;
    sums[gl_LocalInvocationID.x] = count;
    barrier();
    if (gl_LocalInvocationID.x != 0u) return;
    for (int i = 1; i < kTile; ++i) count += sums[i];
    tile_count[tile.y * tiles_in_a_row() + tile.x] = count;
}
