#version 450 core
// Where a pass over a tile list draws. The text is the same for all such passes, which share its machine code.
out gl_PerVertex { vec4 gl_Position; };
layout(std140, binding = 7) uniform TilesBlock {
    vec4 tile_grid_size;
    int tile_side;
};
layout(std430, binding = 0) readonly buffer RunsBuffer { uvec4 runs[]; };
#define TILE_RUNS runs
#define TILE_SIDE tile_side
#include <tile_runs.glsl>

void main() { gl_Position = tile_position(); }
