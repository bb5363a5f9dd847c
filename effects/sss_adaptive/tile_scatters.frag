#version 450 core
#include <pass>
#include "tile.glsl"

void main() {
    ivec2 corner = kTile * ivec2(gl_FragCoord.xy);
    uint any_key = 0u;
    for (int i = 0; i < kTile * kTile; ++i) {
        ivec2 p = corner + ivec2(i % kTile, i / kTile);
        if (all(lessThan(p, frame.size))) any_key |= texelFetch(facet, p, 0).r;
    }
    out_tile_scatters = any_key != 0u ? 1.0 : 0.0;
}
