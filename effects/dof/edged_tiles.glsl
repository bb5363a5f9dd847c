#include "tile.glsl"
#include <lens/highlight.glsl>

// Tiles of which tile_coc looks at each pixel.
bool edged_tiles(ivec2 tile) {
    vec4 found = texelFetch(tile_step, tile, 0);
    return found.b < found.a - kClear || may_be_repaired(found);
}
