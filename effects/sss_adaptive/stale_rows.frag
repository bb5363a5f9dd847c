#version 450 core
#include <pass>
#include "tile.glsl"

// Whether a blur along rows reads anything from this tile that changed since the frame before.
void main() {
    ivec2 tile = ivec2(gl_FragCoord.xy);
    int reach = tiles_of(texelFetch(tile_state, tile, 0).g), last = min(tile.x + reach, int(tile_state_size.x) - 1);
    bool stale = false;
    for (int x = max(tile.x - reach, 0); x <= last && !stale; ++x) stale = texelFetch(tile_state, ivec2(x, tile.y), 0).r > 0.0;
    out_stale_rows = stale ? 1.0 : 0.0;
}
