#include "plate_at.glsl"

// What plate_at gives, for a texel of a level of `light` that shows `visible`.
Light plate_tap(ivec2 texel, int level, Light visible) {
    texel = clamp(texel, ivec2(0), max(frame.size >> level, ivec2(1)) - 1);
    if (level > 0) return unpack_light(texelFetch(plate_half, min(texel << (level - 1), (frame.size + 1) / 2 - 1), 0));
    Light patched = unpack_light(texelFetch(plate, texel, 0));
    return is_patch(patched) ? patched : visible;
}
