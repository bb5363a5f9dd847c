#include "plate_at.glsl"

// What plate_at gives, for a texel that shows `visible`: of level 0, and of a coarse one.
Light plate_tap(ivec2 texel, Light visible) {
    Light patched = unpack_light(imageLoad(plate, clamp(texel, ivec2(0), frame.size - 1)));
    return is_patch(patched) ? patched : visible;
}
Light plate_coarse(ivec2 texel, int level, Grid grid) {
    texel = clamp(texel, ivec2(0), grid.last) << (level - 1);
    return unpack_light(imageLoad(plate_half, min(texel, (frame.size + 1) / 2 - 1)));
}
