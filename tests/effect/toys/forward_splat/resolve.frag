#version 450 core
#include <pass>

const uint kNobody = 0xffffffffu;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    bool hit = texelFetch(nearest, p, 0).r != kNobody;
    out_color = hit ? texelFetch(landed, p, 0) : texelFetch(color, p, 0);
}
