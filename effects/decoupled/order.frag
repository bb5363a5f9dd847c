#version 450 core
#include <pass>
#include "order.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float depth_m = texelFetch(depth, p, 0).r;
    out_order = texelFetch(coc, p, 0).r + kPxPerOctave * (depth_m > 0.0 ? min(log2(depth_m), kInfinityOctaves) : kInfinityOctaves);
}
