#version 450 core
#include <pass>
#include "motion.glsl"
#include "tile_kinds.glsl"

// How far the middle of a tile lies from the line between two points, in the norm in which tiles are circles.
float distance_px(vec2 point, vec2 from, vec2 to) {
    vec2 along = to - from;
    float part = clamp(dot(point - from, along) / max(dot(along, along), 1e-6), 0.0, 1.0);
    vec2 apart = abs(point - from - part * along);
    return max(apart.x, apart.y);
}

// Guertin's off-axis rule, for every tile within reach: only what passes over this tile counts.
bool passes_over(ivec2 offset, vec4 path) {
    vec2 here = -float(kTile) * vec2(offset);
    float nearest_px = min(distance_px(here, vec2(0.0), way_px(path, kOpens)), distance_px(here, vec2(0.0), way_px(path, kCloses)));
    return nearest_px <= float(kTile) + 1.0;
}

// Where the nearest thing moves past what is further and moves otherwise, it is sought from a path of its own; and where there
// are more samples than a word has bits.
bool is_crowded(vec4 furthest, vec4 near, float near_m, float far_m) {
#if METHOD == METHOD_BOWLES_2012
    return tap_count(furthest) > kTimes || (kInFront * near_m < far_m && !is_alike(furthest, near));
#else
    return false;
#endif
}

// Of the longest way nearby, in tiles: how far the search must go.
int reach_tiles(ivec2 p) {
    int range = int(ceil(param.max_blur / float(kTile)));
    float way = 0.0;
    for (int y = -range; y <= range; ++y)
        for (int x = -range; x <= range; ++x)
            way = max(way, textureLod(tile_way, (vec2(p + ivec2(x, y)) + 0.5) * tile_way_size.zw, 0.0).r);
    return min(int(ceil(way / float(kTile))), range);
}

void main() {
    ivec2 last = ivec2(tile_path_size.xy) - 1, p = ivec2(gl_FragCoord.xy);
    int range = max(reach_tiles(p), 1);
    vec4 furthest = texelFetch(tile_path, p, 0), low = texelFetch(tile_low, p, 0), high = texelFetch(tile_high, p, 0);
    float way = longest_way_px(furthest), near_m = texelFetch(tile_depth, p, 0).r;
    vec4 near = texelFetch(tile_near, p, 0);
    for (int y = max(p.y - range, 0); y <= min(p.y + range, last.y); ++y)
        for (int x = max(p.x - range, 0); x <= min(p.x + range, last.x); ++x) {
            vec4 path = texelFetch(tile_path, ivec2(x, y), 0);
            ivec2 offset = ivec2(x, y) - p;
            float its_way = longest_way_px(path), gap = float((max(max(abs(offset.x), abs(offset.y)), 1) - 1) * kTile);
            if (its_way <= gap - 1.0 || !passes_over(offset, path)) continue;
            low = min(low, texelFetch(tile_low, ivec2(x, y), 0));
            high = max(high, texelFetch(tile_high, ivec2(x, y), 0));
            vec4 its_near = texelFetch(tile_near, ivec2(x, y), 0);
            float its_m = texelFetch(tile_depth, ivec2(x, y), 0).r;
            if (its_m < near_m && longest_way_px(its_near) > gap - 1.0 && passes_over(offset, its_near)) {
                near = its_near;
                near_m = its_m;
            }
            furthest = its_way > way ? path : furthest;
            way = max(way, its_way);
        }
    vec4 spread = high - low;
    vec2 apart = (spread.xy + spread.zw * kFurthestTime) * kFurthestTime;
    out_around_path = furthest;
    out_around_near = near;
    out_around_depth = near_m;
    out_around_kind = way < kLeastWay ? kStill : max(apart.x, apart.y) <= kAlike ? kEven
                    : is_crowded(furthest, near, near_m, texelFetch(tile_way, p, 0).g) ? kCrowded : kUneven;
}
