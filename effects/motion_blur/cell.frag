#version 450 core
#include <pass>
#include "packed_motion.glsl"
#ifdef SHARES_PIXELS
#include "layer_motion.glsl"
#endif

// Of the four numbers of a path as they are packed, in the order of packed_numbers.
uvec2 pack_numbers(ivec4 numbers) { return uvec2(uvec2(numbers.xz) >> 16 | (uvec2(numbers.yw) & 0xffff0000u)); }

void main() {
    ivec2 last = frame.size - 1, corner = kCell * ivec2(gl_FragCoord.xy);
    int side = texelFetch(tile_moves, corner / kTile, 0).r == 0u ? 0 : kCell;  // a tile at rest takes no turn of the loops
    uvec2 furthest = uvec2(0u), near = uvec2(0u);
    ivec4 low = ivec4(0x7fffffff), high = ivec4(0x80000000);
    float way = 0.0, near_m = 3e38, far_m = 0.0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            ivec2 p = min(corner + ivec2(x, y), last);
            uvec2 words = packed_path_at(p);
            vec2 known = depth_and_share(p);
            ivec4 numbers = packed_numbers(words);
            float its_way = longest_way_px(vec4(numbers));
            low = min(low, numbers);
            high = max(high, numbers);
#ifdef SHARES_PIXELS
            if (known.y < 1.0) {
                ivec4 behind = packed_numbers(pack_path(second_motion(p).path));
                low = min(low, behind);
                high = max(high, behind);
            }
#endif
#ifdef HAS_FOREGROUND_PLACE
            // What the lens spreads here moves over the cell, too. What it covers widens the range alone: its own tiles bring its path.
            ivec2 sender = sender_of(p);
            uvec2 sent = packed_path_at(sender);
            ivec4 sent_numbers = packed_numbers(sent), covered = packed_numbers(packed_path_at(covered_by_light(p)));
            float sent_way = longest_way_px(vec4(sent_numbers)), sent_m = depth_of(sender);
            low = min(low, min(sent_numbers, covered));
            high = max(high, max(sent_numbers, covered));
            furthest = sent_way > way ? sent : furthest;
            way = max(way, sent_way);
            near = sent_m < near_m ? sent : near;
            near_m = min(near_m, sent_m);
#endif
            near = known.x < near_m ? words : near;
            near_m = min(near_m, known.x);
            far_m = max(far_m, known.x);
            furthest = its_way > way ? words : furthest;
            way = max(way, its_way);
        }
    if (side == 0) low = high = ivec4(0);
    out_cell_paths = uvec4(furthest, near);
    out_cell_range = uvec4(pack_numbers(low), pack_numbers(high));
    out_cell_extent = vec4(longest_way_px(unpack_path(furthest)), far_m, near_m, 0.0);
}
