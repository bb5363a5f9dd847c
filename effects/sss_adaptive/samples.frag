#version 450 core
#include <pass>

void main() { out_samples = texelFetch(epoch, ivec2(gl_FragCoord.xy), 0).g; }
