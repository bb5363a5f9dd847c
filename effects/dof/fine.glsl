#include "near_tiles.glsl"
#include "levels.glsl"
#include "taps.glsl"

// Whether something that a pixel of the tile hides may be in focus, and its patch needs every pixel.
bool has_fine_patches(ivec2 tile) {
    ivec2 corner = tile * kTile / 2, last = ivec2(guessed_size.xy) - 1;
    int side = near_tiles(tile) ? kTile / 2 : 0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            ivec2 texel = min(corner + ivec2(x, y), last);
            float least_px = min(abs(unpack_light(texelFetch(guessed, texel, 0)).coc), abs(unpack_light(texelFetch(guessed_far, texel, 0)).coc));
            if (least_px < kFullSizePx) return true;
        }
    return false;
}
