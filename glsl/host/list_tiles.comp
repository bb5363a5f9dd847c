#version 450 core
#include <pass>
#include <predicate>

// Lists runs of tiles in a row for which is_listed() holds, for draws over them: see tile_runs.glsl.
layout(local_size_x = 1, local_size_y = 16) in;

// Each invocation takes 16 tiles of a row. The order of the runs differs from time to time, the picture does not: no two of their
// quads touch a texel.
void main() {
    ivec2 tiles = (ivec2(tile_grid_size.xy) + TILE_SIDE - 1) / TILE_SIDE;
    ivec2 tile = ivec2(16 * gl_WorkGroupID.x, gl_GlobalInvocationID.y);
    if (tile.y >= tiles.y) return;
    int end = min(tile.x + 16, tiles.x), first = -1;
    for (int x = tile.x; x <= end; ++x) {
        bool goes_on = x < end && is_listed(ivec2(min(x, tiles.x - 1), tile.y));
        if (goes_on && first < 0) first = x;
        if (!goes_on && first >= 0) {
            TILE_RUNS[atomicAdd(TILE_ARGS[1], 1u)] = uvec4(first, tile.y, x, 0);
            first = -1;
        }
    }
}
