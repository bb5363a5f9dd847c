#version 450 core
#include <pass>
#include "highlight.glsl"

// Two steps lead to a diagonal neighbour.
bool is_drawn(ivec2 tile) { return texelFetch(coc_step, tile, 0).r > 0.5 * kOneSurfacePx; }

#define RUNS repaired_runs
#define ARGS repaired_args
#include <list_runs.glsl>

void main() { list_runs(ivec2(coc_step_size.xy)); }
