#version 450 core
#include <pass>
#include "arrow.glsl"

layout(location = 0) flat in vec4 tail_and_way;
layout(location = 1) flat in vec4 paint;

void main() {
    float cover = arrow_cover(Arrow(tail_and_way.xy, tail_and_way.zw, paint.w), gl_FragCoord.xy);
    out_arrows = vec4(paint.rgb, 1.0) * cover;
}
