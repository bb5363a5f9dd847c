#include "plate_at.glsl"

// Where the texels of a level lie in the clean plate: coarser ones than half size have the one at their corner.
struct PlateGrid {
    int shift;
    int first_row;
    ivec2 last;
};

PlateGrid plate_grid_of(int level) {
    bool is_half = level > 0;
    return PlateGrid(max(level - 1, 0), is_half ? room_row() : 0, (is_half ? frame.size + 1 >> 1 : frame.size) - 1);
}

int plate_row(int y, PlateGrid grid) { return grid.first_row + min(y << grid.shift, grid.last.y); }

// What plate_at gives, for a texel within the level that shows `visible`.
Light plate_of(int x, int row, PlateGrid grid, Light visible) {
    Light patched = unpack_plate(texelFetch(plate, ivec2(min(x << grid.shift, grid.last.x), row), 0));
    return is_patch(patched) ? patched : visible;
}
