#version 450 core
#include <pass>
#include <tile_runs.glsl>
#include "coarse.glsl"

// A run of tiles where LEVEL lies in `coarse`, which is 3/4 of the frame's size.
void main() {
    vec2 px = 0.5 * (tile_position().xy * vec2(1.0, -1.0) + 1.0) * tile_grid_size.xy;
    Grid grid = grid_of(LEVEL);
    vec2 p = vec2(grid.origin + min(ivec2(px + 0.5) >> LEVEL, grid.last + 1));
    vec2 size = 0.75 * tile_grid_size.xy;
    gl_Position = vec4(2.0 * p.x / size.x - 1.0, 1.0 - 2.0 * p.y / size.y, 0.0, 1.0);
}
