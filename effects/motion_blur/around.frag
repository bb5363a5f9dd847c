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

// What moves by less than a cell's side comes over the tile from the cells beside it alone. Not with layers: a pixel that surfaces
// share has light of those beside it.
bool is_from_beside(float way) {
#ifdef KNOWS_LAYERS
    return false;
#else
    return way > 0.0 && way < float(kCell - 1);
#endif
}

void take_nearest_cells(ivec2 tile, float way, inout vec4 low, inout vec4 high) {
    const int kSide = kTile / kCell;
    ivec2 last_cell = ivec2(cell_range_size.xy) - 1;
    int last = is_from_beside(way) ? kSide : -2;  // other tiles take no turn of the loops
    vec4 least = vec4(1e30), most = vec4(-1e30);
    for (int y = -1; y <= last; ++y)
        for (int x = -1; x <= last; ++x) {
            ivec2 cell = clamp(kSide * tile + ivec2(x, y), ivec2(0), last_cell);
            uvec4 range = texelFetch(cell_range, cell, 0);
            least = min(least, unpack_path(range.xy));
            most = max(most, unpack_path(range.zw));
        }
    low = last < 0 ? low : least;
    high = last < 0 ? high : most;
}

// Alike within a tenth of the sweep.
bool is_even(vec4 furthest, vec4 low, vec4 high) {
    vec4 spread = high - low;
    vec2 apart = (spread.xy + spread.zw * kFurthestTime) * kFurthestTime;
    return max(apart.x, apart.y) <= max(kAlike, 0.1 * sweep_px(furthest));
}

bool is_still(vec4 low, vec4 high) {
    vec4 most = max(abs(low), abs(high));
    vec2 way = (most.xy + most.zw * kFurthestTime) * kFurthestTime;
    return dot(way, way) < kLeastWay * kLeastWay;
}

// Of the longest way nearby, in tiles: how far the search must go.
int reach_tiles(ivec2 p) {
    int range = int(ceil(param.max_blur / float(kTile)));
    float way = 0.0;
    for (int y = -range; y <= range; y += 2)
        for (int x = -range; x <= range; x += 2) {
            vec4 four = textureGather(tile_way, vec2(p + ivec2(x, y) + 1) * tile_way_size.zw);
            way = max(way, max(max(four.x, four.y), max(four.z, four.w)));
        }
    return min(int(ceil(way / float(kTile))), range);
}

// Whether light of the lens may come over the tile from this one.
bool sends_light(ivec2 tile) {
#ifdef HAS_TILE_VEILED
    return texelFetch(tile_veiled, tile, 0).r > 0.0;
#else
    return false;
#endif
}

void main() {
    ivec2 last = ivec2(tile_path_size.xy) - 1, p = ivec2(gl_FragCoord.xy);
    int range = max(reach_tiles(p), 1);
    vec4 furthest = texelFetch(tile_path, p, 0), low = texelFetch(tile_low, p, 0), high = texelFetch(tile_high, p, 0);
    float way = longest_way_px(furthest), near_m = texelFetch(tile_depth, p, 0).r;
    vec4 near = texelFetch(tile_near, p, 0);
    bool is_veiled = sends_light(p);
    for (int y = max(p.y - range, 0); y <= min(p.y + range, last.y); ++y)
        for (int x = max(p.x - range, 0); x <= min(p.x + range, last.x); ++x) {
            vec4 path = texelFetch(tile_path, ivec2(x, y), 0);
            ivec2 offset = ivec2(x, y) - p;
            float its_way = longest_way_px(path), gap = float((max(max(abs(offset.x), abs(offset.y)), 1) - 1) * kTile);
            if (its_way <= gap - 1.0 || !passes_over(offset, path)) continue;
            is_veiled = is_veiled || sends_light(ivec2(x, y));
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
    take_nearest_cells(p, way, low, high);
    out_around_path = furthest;
    out_around_near = near;
    out_around_depth = near_m;
    out_around_kind = way < kLeastWay || is_still(low, high) ? kStill : is_even(furthest, low, high) ? kEven
                    : is_veiled                                  ? kVeiled
                    : is_crowded(furthest, near, near_m, texelFetch(tile_way, p, 0).g) ? kCrowded : kUneven;
}
