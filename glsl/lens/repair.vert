#version 450 core
#include <pass>
#include "highlight.glsl"

// A quad over a run of tiles.
void main() {
    uvec4 run = repaired_runs[gl_InstanceID];
    vec2 p = float(kRepairTile) * vec2((gl_VertexID & 1) == 0 ? run.x : run.z, run.y + uint(gl_VertexID >> 1));
    vec2 size = vec2(frame.size);
    gl_Position = vec4(2.0 * p.x / size.x - 1.0, 1.0 - 2.0 * p.y / size.y, 0.0, 1.0);
}
