#version 450 core
#include <pass>
#include <predicate>
#include <tile_groups.glsl>

// Lists rectangles of tiles for which is_listed() holds, for draws over them: see tile_runs.glsl. The fourth words have nothing to do
// with the rectangles: they hold the tiles of each group, bit by bit, for passes that run as compute
// shaders.
layout(local_size_x = 1, local_size_y = 16) in;

shared uint rows[16];  // a bit for each tile that is listed

// Each invocation takes 16 tiles of a row. Runs of tiles that begin and end alike in rows below each other become one rectangle, which
// the topmost row lists. The order of the rectangles differs from time to time, the picture does not: no two of them touch a texel.
void main() {
    ivec2 tiles = (ivec2(tile_grid_size.xy) + TILE_SIDE - 1) / TILE_SIDE;
    ivec2 tile = ivec2(16 * gl_WorkGroupID.x, gl_GlobalInvocationID.y);
    int row = int(gl_LocalInvocationID.y);
    uint listed = 0u;
    int count = tile.y < tiles.y ? min(16, tiles.x - tile.x) : 0;
    for (int i = 0; i < count; ++i)
        if (is_listed(tile + ivec2(i, 0))) listed |= 1u << i;
    if (tile.y < tiles.y) TILE_RUNS[tile_group(tile, tiles.x)].w = listed;
    rows[row] = listed;
    barrier();
    uint above = row > 0 ? rows[row - 1] : 0u;
    // Software GL steps over an atomic that no tile needs as slowly as over one that all do, unless a loop ends before it.
    while (listed != 0u) {
        int first = findLSB(listed), end = first + findLSB(~(listed >> first));
        uint run = (1u << end) - (1u << first), around = run | run << 1 | run >> 1;
        listed &= ~0u << end;
        if ((above & around) == run) continue;
        int last = row;
        while (last < 15 && (rows[last + 1] & around) == run) ++last;
        uint rectangle = atomicAdd(TILE_ARGS[1], 1u);
        // At once: each store takes software GL a loop over the invocations, which takes long to compile.
        TILE_RUNS[rectangle].xyz = uvec3(tile.x + first, tile.y, uint(tile.x + end) | uint(tile.y + last - row + 1) << 16);
    }
}
