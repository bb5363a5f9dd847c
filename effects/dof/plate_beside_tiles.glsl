#include "near_tile.glsl"

const int kPlateTile = 16;  // texels of `plate`, as effect.json declares it

// Tiles of the clean plate at half size that hold texels of near tiles.
bool plate_beside_tiles(ivec2 tile) {
    ivec2 corner = kPlateTile * tile - ivec2(0, frame.size.y), end = corner + kPlateTile - 1, last = (frame.size - 1) / kTile;
    if (end.y < 0) return false;
    ivec2 first = min(2 * max(corner, ivec2(0)) / kTile, last), most = min(2 * end / kTile, last);
    for (int y = first.y; y <= most.y; ++y)
        for (int x = first.x; x <= most.x; ++x)
            if (is_near(ivec2(x, y))) return true;
    return false;
}
