#version 450 core
// Where a pass over tiles has drawn: as tiles.vert, by the host's numbers instead of the pass's own.
layout(std140, binding = 0) uniform WipeBlock {
    vec4 tile_grid_size;
    uvec4 value;
    int tile_side;
};
layout(std430, binding = 0) readonly buffer RunsBuffer { uvec4 runs[]; };
#define TILE_RUNS runs
#define TILE_SIDE tile_side
#include <tile_runs.glsl>

void main() { gl_Position = tile_position(); }
