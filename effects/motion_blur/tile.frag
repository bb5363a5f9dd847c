#version 450 core
#include <pass>
#include "motion.glsl"
#ifdef SHARES_PIXELS
#include "layer_motion.glsl"
#endif

void main() {
    ivec2 last = frame.size - 1, corner = kTile * ivec2(gl_FragCoord.xy);
    int side = texelFetch(tile_moves, ivec2(gl_FragCoord.xy), 0).r == 0u ? 0 : kTile;  // a tile at rest takes no turn of the loops
    vec4 furthest = vec4(0.0), low = vec4(1e30), high = vec4(-1e30);
    float way = 0.0, near_m = 3e38, far_m = 0.0;
    vec4 near = vec4(0.0);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            ivec2 p = min(corner + ivec2(x, y), last);
            Motion m = unpack_motion(textureLod(motion, (vec2(p) + 0.5) * motion_size.zw, 0.0));
            low = min(low, m.path);
            high = max(high, m.path);
#ifdef SHARES_PIXELS
            if (m.share < 1.0) {
                vec4 behind = second_motion(p).path;
                low = min(low, behind);
                high = max(high, behind);
            }
#endif
            near = m.depth_m < near_m ? m.path : near;
            near_m = min(near_m, m.depth_m);
            far_m = max(far_m, m.depth_m);
            furthest = m.way_px > way ? m.path : furthest;
            way = max(way, m.way_px);
        }
    out_tile_path = furthest;
    out_tile_near = near;
    out_tile_way = vec2(way, far_m);
    out_tile_depth = near_m;
    out_tile_low = side > 0 ? low : vec4(0.0);
    out_tile_high = side > 0 ? high : vec4(0.0);
}
