#version 450 core
#include <pass>

void main() { out_samples = texelFetch(estimate, ivec2(gl_FragCoord.xy), 0).a; }
