#version 450 core
#include <pass>

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float weight = texelFetch(open, p, 0).g;
    out_color = weight > 0.0 ? texelFetch(front, p, 0) / weight : texelFetch(color, p, 0);
}
