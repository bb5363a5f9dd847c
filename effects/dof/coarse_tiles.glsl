#include "coarse.glsl"
#include "tile.glsl"

const int kCoarseTile = 32;  // texels of `light`, as effect.json declares it

// Tiles that hold texels of a coarse level of a lit tile, of which a fetch takes four. The loops test at their end: llvmpipe runs the body of the
// others once more, with every tile masked. A tile too many costs its texels alone.
bool coarse_tiles(ivec2 tile) {
    ivec2 corner = kCoarseTile * tile, end = corner + kCoarseTile - 1;
    int level = 4, last_level = 0;
    for (int i = 1; i <= 3; ++i) {
        Grid grid = grid_of(i);
        if (any(lessThan(end, grid.origin)) || any(greaterThan(corner, grid.origin + grid.last))) continue;
        level = min(level, i);
        last_level = i;
    }
    if (last_level == 0) return false;
    float sum = 0.0;
    do {
        Grid grid = grid_of(level);
        ivec2 first = (max(corner - grid.origin, ivec2(0)) << level) / kTile, last = (min(end - grid.origin, grid.last) << level) / kTile;
        int y = first.y;
        do {
            int x = first.x;
            do {
                sum += dot(textureGather(lit, vec2(x + 1, y + 1) * lit_size.zw), vec4(1.0));
                x += 2;
            } while (x <= last.x);
            y += 2;
        } while (y <= last.y);
    } while (++level <= last_level);
    return sum > 0.5;
}
