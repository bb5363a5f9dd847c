#version 450 core
#include <pass>
#include "gauss.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    int last = int(quarter_size.x) - 1;
    out_low_x = vec4(0.0);
    out_low_x_coc = 0.0;
    for (int i = -kReach; i <= kReach; ++i) {
        ivec2 q = ivec2(clamp(p.x + i, 0, last), p.y);
        out_low_x += kWeights[abs(i)] * texelFetch(quarter, q, 0);
        out_low_x_coc += kWeights[abs(i)] * texelFetch(quarter_coc, q, 0).r;
    }
}
