#version 450 core
#include <pass>
#include "reach.glsl"

layout(local_size_x = 1, local_size_y = 16) in;

bool is_blurred(ivec2 tile) {
    vec2 own = texelFetch(tile_coc, tile, 0).rg;
    float reach_px = front_reach_px(texelFetch(around, tile, 0), own.y);
    return max(max(-own.x, own.y), reach_px) >= kLeastBlurPx;
}

// Each invocation takes a row of tiles, in 16 columns of a work group. Runs, because a draw of many small quads costs software
// GL twice as much. Their order differs from run to run, the picture does not: no two of the draws touch a pixel.
void main() {
    ivec2 tiles = ivec2(tile_coc_size.xy), tile = ivec2(16 * gl_WorkGroupID.x, gl_GlobalInvocationID.y);
    if (tile.y >= tiles.y) return;
    int end = min(tile.x + 16, tiles.x), first = -1;
    for (int x = tile.x; x <= end; ++x) {
        bool goes_on = x < end && is_blurred(ivec2(min(x, tiles.x - 1), tile.y));
        if (goes_on && first < 0) first = x;
        if (!goes_on && first >= 0) {
            blurred_runs[atomicAdd(blurred_args[1], 1u)] = uvec4(first, tile.y, x, 0);
            first = -1;
        }
    }
}
