#version 450 core
#include <pass>

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float samples = float(param.samples);
    out_color = texelFetch(color, p, 0) + texelFetch(sum, p, 0) / samples + texelFetch(highlights, p, 0);
    out_shares = texelFetch(gaps, p, 0).rg / samples;
}
