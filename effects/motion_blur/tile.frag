#version 450 core
#include <pass>
#include "motion.glsl"

void main() {
    ivec2 last = ivec2(motion_size.xy) - 1, corner = kTile * ivec2(gl_FragCoord.xy);
    Motion m = unpack_motion(texelFetch(motion, min(corner, last), 0));
    vec4 furthest = m.path, low = m.path, high = m.path;
    float way = m.way_px;
    for (int y = 0; y < kTile; ++y)
        for (int x = 0; x < kTile; ++x) {
            m = unpack_motion(texelFetch(motion, min(corner + ivec2(x, y), last), 0));
            low = min(low, m.path);
            high = max(high, m.path);
            furthest = m.way_px > way ? m.path : furthest;
            way = max(way, m.way_px);
        }
    out_tile_path = furthest;
    out_tile_low = low;
    out_tile_high = high;
}
