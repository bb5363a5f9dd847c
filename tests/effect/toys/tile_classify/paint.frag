#version 450 core
#include <pass>

layout(location = 0) flat in uint tile_index;

void main() { out_color = vec4(TINT.x, float(tile_index), TINT.y, 1.0); }
