#version 450 core
#include <pass>
#include <tile_runs.glsl>
#include "tile.glsl"

// A quad over a run of tiles. Edges count in px at full size, also where the target has half of it.
void main() {
    vec2 size = TARGET_IS_HALF == 1 ? vec2((frame.size + 1) / 2 * 2) : vec2(frame.size);
    gl_Position = run_position(blurred_runs[gl_InstanceID], kTile, size);
}
