#version 450 core
#include <pass>
#include "surfel.glsl"

const int kTile = 16;

void main() {
    ivec2 corner = kTile * ivec2(gl_FragCoord.xy), end = min(corner + kTile, frame.size);
    float furthest = 0.0;
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x)
            furthest = max(furthest, reach_px(texelFetch(coc, ivec2(x, y), 0).r, path_at(ivec2(x, y))));
    out_reach_tile = furthest;
}
