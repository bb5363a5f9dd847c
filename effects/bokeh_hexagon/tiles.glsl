// Which tiles of the grids and of the picture are drawn.
#include "tile.glsl"
#include "make_grid.glsl"

// Whether a tile of a grid's texture lies over a tile of the picture that needs it; `needs` picks the grid's part of `grids`.
bool is_needed(ivec2 tile, float spacing, vec2 needs) {
    Grid grid = make_grid(1.0);
    vec2 step = spacing * vec2(grid.a.x, kCell / grid.a.x);
    vec2 low = step * vec2(kTile * tile - kMargin) - 2.0 * spacing, high = low + step * float(kTile) + 4.0 * spacing;
    ivec2 last = ivec2(grids_size.xy) - 1;
    ivec2 first = clamp(ivec2(floor(low)) / kTile, ivec2(0), last), end = clamp(ivec2(floor(high)) / kTile, ivec2(0), last);
    for (int y = first.y; y <= end.y; ++y)
        for (int x = first.x; x <= end.x; ++x)
            if (dot(texelFetch(grids, ivec2(x, y), 0).zw, needs) > 0.0) return true;
    return false;
}

bool fine_tiles(ivec2 tile) { return is_needed(tile, 1.0, vec2(1.0, 0.0)); }

bool coarse_tiles(ivec2 tile) { return is_needed(tile, 2.0, vec2(0.0, 1.0)); }

bool blurred_tiles(ivec2 tile) { return texelFetch(grids, tile, 0).y >= kLeastBlurPx; }
