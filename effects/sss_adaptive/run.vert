#version 450 core
#include <pass>
#include <tile_runs.glsl>
#include "tile.glsl"

// A quad over a run of tiles.
void main() { gl_Position = run_position(RUNS[gl_InstanceID], kTile, vec2(frame.size)); }
