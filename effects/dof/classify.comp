#version 450 core
#include <pass>
#include "reach.glsl"

bool is_drawn(ivec2 tile) {
    vec2 own = texelFetch(tile_coc, tile, 0).rg;
    float reach_px = front_reach_px(texelFetch(around, tile, 0), own.y);
    return max(max(-own.x, own.y), reach_px) >= kLeastBlurPx;
}

#define RUNS blurred_runs
#define ARGS blurred_args
#include <list_runs.glsl>

void main() { list_runs(ivec2(tile_coc_size.xy)); }
