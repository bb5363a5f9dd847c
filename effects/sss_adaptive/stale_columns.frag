#version 450 core
#include <pass>
#include "tile.glsl"

// Whether a blur along columns reads anything from this tile that the blur along rows made anew.
void main() {
    ivec2 tile = ivec2(gl_FragCoord.xy);
    int reach = tiles_of(texelFetch(tile_state, tile, 0).g), last = min(tile.y + reach, int(tile_state_size.y) - 1);
    bool stale = false;
    for (int y = max(tile.y - reach, 0); y <= last && !stale; ++y) stale = texelFetch(stale_rows, ivec2(tile.x, y), 0).r > 0.0;
    out_stale_columns = stale ? 1.0 : 0.0;
}
