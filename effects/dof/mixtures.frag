#version 450 core
#include <pass>
#include "mixed_tiles.glsl"
#include "tile.glsl"

void main() {
    ivec2 tile = ivec2(gl_FragCoord.xy), last = frame.size - 1;
    int side = mixed_tiles(tile) ? kTile : 0;
    vec2 sum = vec2(0.0);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            float kind = texelFetch(mixture, min(kTile * tile + ivec2(x, y), last), 0).r;
            sum += vec2(kind > 0.9 ? 1.0 : 0.0, kind > 0.25 ? 1.0 : 0.0);
        }
    out_mixtures = sum;
}
