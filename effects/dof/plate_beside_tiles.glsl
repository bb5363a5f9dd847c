#include "near_tile.glsl"
#include "coarse.glsl"

const int kPlateTile = 32;  // texels of `plate`, as effect.json declares it
const int kNearTiles = 2 * kPlateTile / kTile;

// Tiles of the clean plate at half size that hold texels of near tiles, four by a gather.
bool plate_beside_tiles(ivec2 tile) {
    ivec2 corner = kPlateTile * tile - ivec2(0, room_row()), first = 2 * corner / kTile;
    if (corner.y < 0) return false;
    vec4 found = vec4(0.0);
    for (int y = 1; y < kNearTiles; y += 2)
        for (int x = 1; x < kNearTiles; x += 2) found += textureGather(near_tile, vec2(first + ivec2(x, y)) * near_tile_size.zw);
    return dot(found, vec4(1.0)) > 0.5;
}
