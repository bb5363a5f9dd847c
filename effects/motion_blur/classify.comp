#version 450 core
#include <pass>
#include "motion.glsl"

layout(local_size_x = 1, local_size_y = 16) in;

const int kStill = 0, kEven = 1, kUneven = 2;

int kind_of(ivec2 tile) {
    vec2 way = texelFetch(around_way, tile, 0).xy;
    return way.x < kLeastWay ? kStill : way.y <= kAlike ? kEven : kUneven;
}

void add_run(int kind, uvec4 run) {
    if (kind == kEven) even_runs[atomicAdd(even_args[1], 1u)] = run;
    if (kind == kUneven) uneven_runs[atomicAdd(uneven_args[1], 1u)] = run;
}

// Each invocation takes a row of tiles, in 16 columns of a work group. Runs, because a draw of many small quads costs software
// GL twice as much. Their order differs from run to run, the picture does not: no two of the draws touch a pixel.
void main() {
    ivec2 tiles = ivec2(around_way_size.xy), tile = ivec2(16 * gl_WorkGroupID.x, gl_GlobalInvocationID.y);
    if (tile.y >= tiles.y) return;
    int end = min(tile.x + 16, tiles.x), first = tile.x, kind = kind_of(tile);
    for (int x = tile.x + 1; x <= end; ++x) {
        int its_kind = x < end ? kind_of(ivec2(min(x, tiles.x - 1), tile.y)) : kStill;
        if (x < end && its_kind == kind) continue;
        add_run(kind, uvec4(first, tile.y, x, 0));
        first = x;
        kind = its_kind;
    }
}
