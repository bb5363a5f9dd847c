#version 450 core
#include <pass>

void main() { out_color = texelFetch(mean, ivec2(gl_FragCoord.xy), 0); }
