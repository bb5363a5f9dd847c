// What becomes of a tile: the draws of a list, and nothing where nothing moves.
#include "motion.glsl"

const int kStill = 0, kEven = 1, kUneven = 2, kCrowded = 3;

int kind_of(ivec2 tile) {
    vec2 way = texelFetch(around_way, tile, 0).xy;
    if (way.x < kLeastWay) return kStill;
    if (way.y <= kAlike) return kEven;
#if METHOD == METHOD_BOWLES_2012
    vec4 furthest = texelFetch(around_path, tile, 0);
    if (tap_count(furthest) > kTimes || !is_alike(furthest, texelFetch(around_near, tile, 0))) return kCrowded;
#endif
    return kUneven;
}

// Blurs take motion from at most max_blur away. In blocks of kBlock tiles, or the search would cost more than the motion.
const int kBlock = 4;

bool moving_blocks(ivec2 block) {
    ivec2 last = ivec2(around_way_size.xy) - 1, corner = kBlock * block;
    int range = int(ceil(param.max_blur / float(kTile))) + 1;
    for (int y = max(corner.y - range, 0); y <= min(corner.y + kBlock - 1 + range, last.y); ++y)
        for (int x = max(corner.x - range, 0); x <= min(corner.x + kBlock - 1 + range, last.x); ++x)
            if (kind_of(ivec2(x, y)) != kStill) return true;
    return false;
}

bool even_tiles(ivec2 tile) { return kind_of(tile) == kEven; }

bool uneven_tiles(ivec2 tile) { return kind_of(tile) == kUneven; }

bool crowded_tiles(ivec2 tile) { return kind_of(tile) == kCrowded; }
