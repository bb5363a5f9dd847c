#version 450 core
#include <pass>
#include "slices.glsl"

void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) * kTile, end = min(corner + kTile, ivec2(coc_size.xy));
    vec2 largest = vec2(0.0);
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x) {
            float coc = texelFetch(coc, ivec2(x, y), 0).r;
            largest = max(largest, vec2(-coc, coc));
        }
    out_range_tile = largest;
}
