#version 450 core
#include <pass>

bool is_drawn(ivec2 tile) { return texelFetch(LIST, tile, 0).WHICH > 0.0; }

#include <list_runs.glsl>

void main() { list_runs(ivec2(LIST_SIZE.xy)); }
