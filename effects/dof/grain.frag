#version 450 core
#include <pass>
#include "levels.glsl"
#include "taps.glsl"

// Whether something that a pixel of a near tile hides may be in focus, and its patch needs every pixel.
bool has_fine_patches(ivec2 tile) {
    ivec2 corner = tile * kTile / 2, last = ivec2(guessed_size.xy) - 1;
    for (int y = 0; y < kTile / 2; ++y)
        for (int x = 0; x < kTile / 2; ++x) {
            ivec2 texel = min(corner + ivec2(x, y), last);
            float least_px = min(abs(unpack_light(texelFetch(guessed, texel, 0)).coc), abs(unpack_light(texelFetch(guessed_far, texel, 0)).coc));
            if (least_px < kFullSizePx) return true;
        }
    return false;
}

void main() {
    bool is_fine = has_fine_patches(ivec2(gl_FragCoord.xy));
    out_guessed_tile = is_fine ? 0.0 : 1.0;
    out_fine_tile = is_fine ? 1.0 : 0.0;
}
