// What becomes of a tile: the draws of the two lists, and neither where nothing moves.
#include "motion.glsl"

const int kStill = 0, kEven = 1, kUneven = 2;

int kind_of(ivec2 tile) {
    vec2 way = texelFetch(around_way, tile, 0).xy;
    return way.x < kLeastWay ? kStill : way.y <= kAlike ? kEven : kUneven;
}

bool even_tiles(ivec2 tile) { return kind_of(tile) == kEven; }

bool uneven_tiles(ivec2 tile) { return kind_of(tile) == kUneven; }
