#include "motion.glsl"

// Blurs take motion from at most max_blur away. In blocks of kBlock tiles, or the search would cost more than the motion.
const int kBlock = 4;

bool moving_blocks(ivec2 block) {
    ivec2 last = ivec2(tile_moves_size.xy) - 1, corner = kBlock * block;
    int range = int(ceil(param.max_blur / float(kTile))) + 1;
    for (int y = max(corner.y - range, 0); y <= min(corner.y + kBlock - 1 + range, last.y); ++y)
        for (int x = max(corner.x - range, 0); x <= min(corner.x + kBlock - 1 + range, last.x); ++x)
            if (texelFetch(tile_moves, ivec2(x, y), 0).r != 0u) return true;
    return false;
}
