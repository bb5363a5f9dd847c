#version 450 core
// Where a pass over tiles has drawn: as tiles.vert, by the host's numbers instead of the pass's own. With WIPE_REST only where it
// does not draw again.
out gl_PerVertex { vec4 gl_Position; };
layout(std140, binding = 0) uniform WipeBlock {
    vec4 tile_grid_size;
    uvec4 value;
    int tile_side;
    int tiles_in_a_row;
};
layout(std430, binding = 0) readonly buffer RunsBuffer { uvec4 runs[]; };
#define TILE_RUNS runs
#define TILE_SIDE tile_side
#include <tile_runs.glsl>

#ifdef WIPE_REST
#include <tile_groups.glsl>
layout(std430, binding = 1) readonly buffer NextRunsBuffer { uvec4 next_runs[]; };

// The rows of a rectangle each lie in one group.
bool is_drawn_again() {
    uvec4 run = runs[gl_InstanceID];
    uint first = run.x % uint(kTilesOfAGroup), tiles = ((1u << ((run.z & 0xffffu) - run.x)) - 1u) << first, left = 0u;
    for (uint y = run.y; y < run.z >> 16; ++y) left |= tiles & ~next_runs[tile_group(ivec2(run.x, y), tiles_in_a_row)].w;
    return left == 0u;
}

void main() { gl_Position = is_drawn_again() ? vec4(0.0, 0.0, 0.0, 1.0) : tile_position(); }
#else
void main() { gl_Position = tile_position(); }
#endif
