// What becomes of a tile: the draws of a list, and nothing where nothing moves.
#include "motion.glsl"
#include "tile_kinds.glsl"

uint kind_of(ivec2 tile) { return texelFetch(around_kind, tile, 0).r; }

// Blurs take motion from at most max_blur away. In blocks of kBlock tiles, or the search would cost more than the motion.
const int kBlock = 4;

bool moving_blocks(ivec2 block) {
    ivec2 last = ivec2(around_kind_size.xy) - 1, corner = kBlock * block;
    int range = int(ceil(param.max_blur / float(kTile))) + 1;
    for (int y = max(corner.y - range, 0); y <= min(corner.y + kBlock - 1 + range, last.y); ++y)
        for (int x = max(corner.x - range, 0); x <= min(corner.x + kBlock - 1 + range, last.x); ++x)
            if (kind_of(ivec2(x, y)) != kStill) return true;
    return false;
}

bool even_tiles(ivec2 tile) { return kind_of(tile) == kEven; }

bool uneven_tiles(ivec2 tile) { return kind_of(tile) == kUneven; }

bool crowded_tiles(ivec2 tile) { return kind_of(tile) == kCrowded; }
