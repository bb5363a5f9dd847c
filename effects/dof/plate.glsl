#include "plate_at.glsl"

// What plate_at gives, for a texel that shows `visible`: of level 0, and of a coarse one, which lies within the level.
Light plate_fine(int x, int y, Light visible) {
    Light patched = unpack_plate(texelFetch(plate, ivec2(x, y), 0));
    return is_patch(patched) ? patched : visible;
}

// Where the texels of a coarse level lie in the plate at half size.
struct PlateGrid {
    int shift;
    ivec2 last;
};

PlateGrid plate_grid_of(int level) { return PlateGrid(level - 1, (frame.size + 1 >> 1) - 1); }
int plate_row(int y, PlateGrid grid) { return min(y << grid.shift, grid.last.y); }
Light plate_coarse(int x, int row, PlateGrid grid) { return unpack_light(texelFetch(plate_half, ivec2(min(x << grid.shift, grid.last.x), row), 0)); }
