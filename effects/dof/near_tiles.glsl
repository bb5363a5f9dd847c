#include "blurred.glsl"
#include <lens/highlight.glsl>

// Whether the edge of a surface lies within a blur of this tile. A slope, however long, hides nothing.
bool has_edge_within(ivec2 tile, float radius_px) {
#ifdef HAS_COC_STEP
    ivec2 last = ivec2(tile_coc_size.xy) - 1;
    int range = int(ceil(radius_px / float(kTile)));
    for (int y = max(tile.y - range, 0); y <= min(tile.y + range, last.y); ++y)
        for (int x = max(tile.x - range, 0); x <= min(tile.x + range, last.x); ++x)
            if (is_repaired(texelFetch(coc_step, ivec2(x, y), 0).r)) return true;
    return false;
#else
    return true;
#endif
}

bool near_tiles(ivec2 tile) {
    vec2 own = texelFetch(tile_coc, tile, 0).rg;
    float radius_px = max(-own.x, own.y);
    return is_blurred(tile) && own.x < texelFetch(around, tile, 0).w - kClear && has_edge_within(tile, radius_px + 1.5);
}
