#version 450 core
#include <pass>
#include <tile_runs.glsl>

void main() { gl_Position = tile_position(); }
