#version 450 core
#include <pass>

void main() { out_samples = texelFetch(plan, ivec2(gl_FragCoord.xy), 0).r; }
