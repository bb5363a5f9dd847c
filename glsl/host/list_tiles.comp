#version 450 core
#include <pass>
#include <predicate>
#include <tile_groups.glsl>

// Lists runs of tiles in a row for which is_listed() holds, for draws over them: see tile_runs.glsl. The fourth words have nothing to
// do with the runs: they hold the tiles of each group, bit by bit, for wipe.vert.
layout(local_size_x = 1, local_size_y = 16) in;

// Each invocation takes 16 tiles of a row. The order of the runs differs from time to time, the picture does not: no two of their
// quads touch a texel.
void main() {
    ivec2 tiles = (ivec2(tile_grid_size.xy) + TILE_SIDE - 1) / TILE_SIDE;
    ivec2 tile = ivec2(16 * gl_WorkGroupID.x, gl_GlobalInvocationID.y);
    if (tile.y >= tiles.y) return;
    uint listed = 0u;
    int group = tile_group(tile, tiles.x);
    int count = min(16, tiles.x - tile.x);
    for (int i = 0; i < count; ++i)
        if (is_listed(tile + ivec2(i, 0))) listed |= 1u << i;
    TILE_RUNS[group].w = listed;
    // Software GL steps over an atomic that no tile needs as slowly as over one that all do, unless a loop ends before it.
    while (listed != 0u) {
        int first = findLSB(listed), end = first + findLSB(~(listed >> first));
        uint run = atomicAdd(TILE_ARGS[1], 1u);
        TILE_RUNS[run].x = uint(tile.x + first);
        TILE_RUNS[run].y = uint(tile.y);
        TILE_RUNS[run].z = uint(tile.x + end);
        listed &= ~0u << end;
    }
}
