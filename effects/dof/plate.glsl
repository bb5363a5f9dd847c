#include "plate_at.glsl"

// What plate_at gives, for a texel that shows `visible`: of level 0, and of a coarse one, which lies within the level.
Light plate_fine(int x, int y, Light visible) {
    Light patched = unpack_light(texelFetch(plate, ivec2(x, y), 0));
    return is_patch(patched) ? patched : visible;
}
int plate_row(int y, int level) { return min(y << (level - 1), (frame.size.y + 1) / 2 - 1); }
Light plate_coarse(int x, int row, int level) { return unpack_light(texelFetch(plate_half, ivec2(min(x << (level - 1), (frame.size.x + 1) / 2 - 1), row), 0)); }
