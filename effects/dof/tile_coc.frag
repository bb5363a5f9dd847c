#version 450 core
#include <pass>
#include <lens/highlight.glsl>
#include "tile.glsl"

void main() {
    ivec2 last = frame.size - 1, corner = kTile * ivec2(gl_FragCoord.xy);
    float smallest = texelFetch(lit_coc, min(corner, last), 0).r, largest = smallest;
    int side = kTile;
    // Elsewhere tile_step has the range.
    vec4 unrepaired = texelFetch(tile_step, ivec2(gl_FragCoord.xy), 0);
    if (!may_be_repaired(unrepaired)) {
        smallest = unrepaired.b;
        largest = unrepaired.a;
        side = 0;
    }
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            float coc_px = texelFetch(lit_coc, min(corner + ivec2(x, y), last), 0).r;
            smallest = min(smallest, coc_px);
            largest = max(largest, coc_px);
        }
    float before = smallest;
    if (smallest < largest - kClear)
        for (int y = 0; y < kTile; ++y)
            for (int x = 0; x < kTile; ++x) {
                float coc_px = texelFetch(lit_coc, min(corner + ivec2(x, y), last), 0).r;
                if (coc_px < largest - kClear) before = max(before, coc_px);
            }
    out_tile_coc = vec4(smallest, largest, before, 0.0);
}
