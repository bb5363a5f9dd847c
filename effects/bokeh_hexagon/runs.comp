#version 450 core
#include <pass>
#include "tile.glsl"
#include "make_grid.glsl"

layout(local_size_x = 1, local_size_y = 16) in;

#ifdef FINE
// Whether a tile of the grid's texture lies over a tile of the picture that needs it.
bool is_drawn(Grid grid, ivec2 tile) {
    vec2 step = kSpacing * vec2(grid.a.x, kCell / grid.a.x);
    vec2 low = step * vec2(kTile * tile - kMargin) - 2.0 * kSpacing, high = low + step * float(kTile) + 4.0 * kSpacing;
    ivec2 last = ivec2(grids_size.xy) - 1;
    ivec2 first = clamp(ivec2(floor(low)) / kTile, ivec2(0), last), end = clamp(ivec2(floor(high)) / kTile, ivec2(0), last);
    for (int y = first.y; y <= end.y; ++y)
        for (int x = first.x; x <= end.x; ++x) {
            vec4 needed = texelFetch(grids, ivec2(x, y), 0);
            if ((FINE == 1 ? needed.z : needed.w) > 0.0) return true;
        }
    return false;
}
#else
bool is_drawn(Grid grid, ivec2 tile) { return texelFetch(grids, tile, 0).y >= kLeastBlurPx; }
#endif

// Each invocation takes 16 tiles of a row. Runs, because a draw of many small quads costs software GL twice as much. Their order
// differs from run to run, the picture does not: no two of the draws touch a texel.
void main() {
    ivec2 tiles = (target_size() + kTile - 1) / kTile, tile = ivec2(16 * gl_WorkGroupID.x, gl_GlobalInvocationID.y);
    if (tile.y >= tiles.y) return;
    Grid grid = make_grid(1.0);
    int end = min(tile.x + 16, tiles.x), first = -1;
    for (int x = tile.x; x <= end; ++x) {
        bool goes_on = x < end && is_drawn(grid, ivec2(min(x, tiles.x - 1), tile.y));
        if (goes_on && first < 0) first = x;
        if (!goes_on && first >= 0) {
            RUNS[atomicAdd(ARGS[1], 1u)] = uvec4(first, tile.y, x, 0);
            first = -1;
        }
    }
}
