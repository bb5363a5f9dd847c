#version 450 core
#include <pass>
#include "tile.glsl"

// A quad over a run of tiles. Edges count in px at full size, also where the target has half of it.
void main() {
    uvec4 run = blurred_runs[gl_InstanceID];
    vec2 p = float(kTile) * vec2((gl_VertexID & 1) == 0 ? run.x : run.z, run.y + uint(gl_VertexID >> 1));
    vec2 size = TARGET_IS_HALF == 1 ? vec2((frame.size + 1) / 2 * 2) : vec2(frame.size);
    gl_Position = vec4(2.0 * p.x / size.x - 1.0, 1.0 - 2.0 * p.y / size.y, 0.0, 1.0);
}
