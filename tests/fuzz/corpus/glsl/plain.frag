#version 450 core
#include <pass>
#include "other.glsl"
/* a */ float t[4];
void main() { out_color = vec4(t[0] + 1.0); } // end
