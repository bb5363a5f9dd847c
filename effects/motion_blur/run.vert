#version 450 core
#include <pass>
#include "motion.glsl"

// A quad over a run of tiles.
void main() {
    uvec4 run = RUNS[gl_InstanceID];
    vec2 p = float(kTile) * vec2((gl_VertexID & 1) == 0 ? run.x : run.z, run.y + uint(gl_VertexID >> 1));
    gl_Position = vec4(2.0 * p.x / float(frame.size.x) - 1.0, 1.0 - 2.0 * p.y / float(frame.size.y), 0.0, 1.0);
}
