#version 450 core
#include <pass>
#include <tile_runs.glsl>
#include "highlight.glsl"

void main() { gl_Position = run_position(repaired_runs[gl_InstanceID], kRepairTile, vec2(frame.size)); }
