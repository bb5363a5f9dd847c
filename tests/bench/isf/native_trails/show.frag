#version 450 core
#include <pass>

void main() { out_display = clamp(trail, 0.0, 1.0); }
