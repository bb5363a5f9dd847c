#version 450 core
#include <pass>

const int kTile = 64;

void main() {
    ivec2 corner = kTile * ivec2(gl_FragCoord.xy), end = min(corner + kTile, ivec2(depth_size.xy));
    vec2 range_log2 = vec2(1e9, -1e9);
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x) {
            float depth_m = texelFetch(depth, ivec2(x, y), 0).r;
            if (isinf(depth_m) || !(depth_m > 0.0)) continue;
            range_log2 = vec2(min(range_log2.x, log2(depth_m)), max(range_log2.y, log2(depth_m)));
        }
    out_range_tile = range_log2;
}
