#include "motion.glsl"

// Blurs take motion from at most max_blur away. In blocks of kBlock tiles, or the search would cost more than the motion.
const int kBlock = 4;

bool moving_blocks(ivec2 block) {
    ivec2 corner = kBlock * block;
    int range = int(ceil(param.max_blur / float(kTile))) + 1;
    for (int y = corner.y - range; y < corner.y + kBlock + range; y += 2)
        for (int x = corner.x - range; x < corner.x + kBlock + range; x += 2)
            if (any(notEqual(textureGather(tile_moves, vec2(x + 1, y + 1) * tile_moves_size.zw), uvec4(0u)))) return true;
    return false;
}
