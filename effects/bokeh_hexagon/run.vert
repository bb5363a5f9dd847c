#version 450 core
#include <pass>
#include <tile_runs.glsl>
#include "make_grid.glsl"

layout(location = 0) flat out vec4 grid_axes;
layout(location = 1) flat out vec3 grid_shear_sign;

// A quad over a run of tiles.
void main() {
    Grid grid = make_grid(1.0);
    grid_axes = vec4(grid.a, grid.b);
    grid_shear_sign = vec3(grid.shear, float(grid.sign));
    gl_Position = tile_position();
}
