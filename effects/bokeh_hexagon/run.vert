#version 450 core
#include <pass>
#include "tile.glsl"
#include "make_grid.glsl"

layout(location = 0) flat out vec4 grid_axes;
layout(location = 1) flat out vec3 grid_shear_sign;

// A quad over a run of tiles.
void main() {
    Grid grid = make_grid(1.0);
    grid_axes = vec4(grid.a, grid.b);
    grid_shear_sign = vec3(grid.shear, float(grid.sign));
    uvec4 run = RUNS[gl_InstanceID];
    vec2 p = float(kTile) * vec2((gl_VertexID & 1) == 0 ? run.x : run.z, run.y + uint(gl_VertexID >> 1));
    vec2 size = vec2(target_size());
    gl_Position = vec4(2.0 * p.x / size.x - 1.0, 1.0 - 2.0 * p.y / size.y, 0.0, 1.0);
}
