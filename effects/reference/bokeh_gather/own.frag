#version 450 core
#include <pass>
#include <lens/shared_color.glsl>

void main() { out_own = shared_color(ivec2(gl_FragCoord.xy)); }
