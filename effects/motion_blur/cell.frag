#version 450 core
#include <pass>
#include "packed_motion.glsl"
#ifdef SHARES_PIXELS
#include "layer_motion.glsl"
#endif

void main() {
    ivec2 last = frame.size - 1, corner = kCell * ivec2(gl_FragCoord.xy);
    int side = texelFetch(tile_moves, corner / kTile, 0).r == 0u ? 0 : kCell;  // a tile at rest takes no turn of the loops
    vec4 furthest = vec4(0.0), low = vec4(1e30), high = vec4(-1e30);
    float way = 0.0, near_m = 3e38, far_m = 0.0;
    vec4 near = vec4(0.0);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            ivec2 p = min(corner + ivec2(x, y), last);
            Motion m = packed_motion(p);
            float its_way = longest_way_px(m.path);
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
            furthest = its_way > way ? m.path : furthest;
            way = max(way, its_way);
        }
    if (side == 0) low = high = vec4(0.0);
    out_cell_paths = uvec4(pack_path(furthest), pack_path(near));
    out_cell_range = uvec4(pack_path(low), pack_path(high));
    out_cell_extent = vec4(way, far_m, near_m, 0.0);
}
