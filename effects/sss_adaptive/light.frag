#version 450 core
#include <pass>
#include "marked_light.glsl"

void main() { out_light = marked_light(ivec2(gl_FragCoord.xy)); }
