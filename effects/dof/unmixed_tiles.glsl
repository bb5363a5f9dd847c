#include "mixed_tiles.glsl"

// Antialiasing mixes a third of the pixels at silhouettes, on both sides alike. With one ray a pixel, texture looks like a mixture at a
// few of them, and the shading of a round surface at many, but on the near side alone.
const float kLeastMixed = 0.08;  // on the far side
const int kAround = 2;  // tiles

bool unmixed_tiles(ivec2 tile) {
    if (!mixed_tiles(tile)) return false;
    ivec2 last = ivec2(mixtures_size.xy) - 1;
    vec2 sum = vec2(0.0);
    for (int y = max(tile.y - kAround, 0); y <= min(tile.y + kAround, last.y); ++y)
        for (int x = max(tile.x - kAround, 0); x <= min(tile.x + kAround, last.x); ++x) sum += texelFetch(mixtures, ivec2(x, y), 0).rg;
    return sum.r < kLeastMixed * sum.g;
}
