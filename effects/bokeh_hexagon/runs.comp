#version 450 core
#include <pass>
#include "tile.glsl"
#include "make_grid.glsl"

#ifdef FINE
// Whether a tile of the grid's texture lies over a tile of the picture that needs it.
bool is_drawn(ivec2 tile) {
    Grid grid = make_grid(1.0);
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
bool is_drawn(ivec2 tile) { return texelFetch(grids, tile, 0).y >= kLeastBlurPx; }
#endif

#include <list_runs.glsl>

void main() { list_runs((target_size() + kTile - 1) / kTile); }
