#version 450 core
#include <pass>
#include "motion.glsl"

// Of a tile, from its cells.
void main() {
    ivec2 last = ivec2(cell_paths_size.xy) - 1, corner = kTile / kCell * ivec2(gl_FragCoord.xy);
    int side = texelFetch(tile_moves, ivec2(gl_FragCoord.xy), 0).r == 0u ? 0 : kTile / kCell;  // a tile at rest takes no turn of the loops
    vec4 furthest = vec4(0.0), near = vec4(0.0), low = vec4(1e30), high = vec4(-1e30);
    float way = 0.0, near_m = 3e38, far_m = 0.0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            ivec2 p = min(corner + ivec2(x, y), last);
            uvec4 paths = texelFetch(cell_paths, p, 0), range = texelFetch(cell_range, p, 0);
            vec3 extent = texelFetch(cell_extent, p, 0).xyz;  // way, far_m, near_m
            low = min(low, unpack_path(range.xy));
            high = max(high, unpack_path(range.zw));
            furthest = extent.x > way ? unpack_path(paths.xy) : furthest;
            near = extent.z < near_m ? unpack_path(paths.zw) : near;
            way = max(way, extent.x);
            far_m = max(far_m, extent.y);
            near_m = min(near_m, extent.z);
        }
    out_tile_path = furthest;
    out_tile_near = near;
    out_tile_way = vec2(way, far_m);
    out_tile_depth = near_m;
    out_tile_low = side > 0 ? low : vec4(0.0);
    out_tile_high = side > 0 ? high : vec4(0.0);
}
