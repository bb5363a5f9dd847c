#include "blurred.glsl"

// How much further than its radius a blur takes texels: half a texel of the coarsest level, and what such a texel shows.
const float kCoarsePx = 12.0;

// Whether a blur of this tile takes light from the clean plate: within its reach, a tile with a patch has something in front of it.
// `is_drawn`: whether it has a blur.
bool is_plated(ivec2 tile, bool is_drawn) {
    ivec2 last = ivec2(tile_coc_size.xy) - 1;
    vec2 own = texelFetch(tile_coc, tile, 0).rg;
    float reach_px = max(-own.x, own.y) + kCoarsePx, bound = own.y - kClear;
    if (texelFetch(patched, tile, 0).r > 0.5) return true;
    int range = is_drawn ? int(ceil(reach_px / float(kTile))) : -1;
    for (int y = max(tile.y - range, 0); y <= min(tile.y + range, last.y); ++y)
        for (int x = max(tile.x - range, 0); x <= min(tile.x + range, last.x); ++x)
            if (texelFetch(patched, ivec2(x, y), 0).r > 0.5 && texelFetch(tile_coc, ivec2(x, y), 0).r < bound) return true;
    return false;
}
