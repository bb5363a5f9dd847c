#version 450 core
#include <pass>
#include "shared_work.glsl"

// Whether pixels of a tile are sampled; whether some are blurred. Ranges are interpolated between tiles' middles, so that a
// pixel's is within those of the tiles beside its own.
void main() {
    ivec2 tile = ivec2(gl_FragCoord.xy), last = ivec2(tile_range_size.xy) - 1;
    float least = 1.0, most = 0.0;
    for (int i = 0; i < 9; ++i) {
        float share = share_of_range(texelFetch(tile_range, clamp(tile + ivec2(i % 3, i / 3) - 1, ivec2(0), last), 0).r);
        least = min(least, share);
        most = max(most, share);
    }
    vec2 kinds = texelFetch(tile_kinds, tile, 0).rg;
    bool sampled = kinds.x > 0.0 && most > 0.0, blurred = kinds.y > 0.0 || (kinds.x > 0.0 && least < 1.0);
    out_tile_class = vec2(sampled, blurred);
}
