#version 450 core
#include <pass>
#include "highlight.glsl"

layout(local_size_x = 1, local_size_y = 16) in;

// Two steps lead to a diagonal neighbour.
bool has_edge(ivec2 tile) { return texelFetch(coc_step, tile, 0).r > 0.5 * kOneSurfacePx; }

// Each invocation takes a row of tiles, in 16 columns of a work group. Runs, because a draw of many small quads costs software
// GL twice as much. Their order differs from run to run, the picture does not: no two of the draws touch a pixel.
void main() {
    ivec2 tiles = ivec2(coc_step_size.xy), tile = ivec2(16 * gl_WorkGroupID.x, gl_GlobalInvocationID.y);
    if (tile.y >= tiles.y) return;
    int end = min(tile.x + 16, tiles.x), first = -1;
    for (int x = tile.x; x <= end; ++x) {
        bool goes_on = x < end && has_edge(ivec2(min(x, tiles.x - 1), tile.y));
        if (goes_on && first < 0) first = x;
        if (!goes_on && first >= 0) {
            repaired_runs[atomicAdd(repaired_args[1], 1u)] = uvec4(first, tile.y, x, 0);
            first = -1;
        }
    }
}
