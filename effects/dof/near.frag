#version 450 core
#include <pass>
#include "edges.glsl"

// Whether a pixel of the tile lies in front of what an edge within its reach has behind it.
void main() {
    ivec2 tile = ivec2(gl_FragCoord.xy), corner = tile * kTile / kBlock, last = ivec2(beyond_size.xy) - 1;
    float behind = kNoEdge;
    for (int i = 0; i < 4; ++i) behind = max(behind, texelFetch(beyond, min(corner + ivec2(i & 1, i >> 1), last), 0).r);
    out_near_tile = texelFetch(tile_coc, tile, 0).r + kBehindPx < behind ? 1.0 : 0.0;
}
