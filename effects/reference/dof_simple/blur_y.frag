#version 450 core
#include <pass>
#include "gauss.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    int last = int(low_x_size.y) - 1;
    out_low = vec4(0.0);
    out_low_coc = 0.0;
    for (int i = -kReach; i <= kReach; ++i) {
        ivec2 q = ivec2(p.x, clamp(p.y + i, 0, last));
        out_low += kWeights[abs(i)] * texelFetch(low_x, q, 0);
        out_low_coc += kWeights[abs(i)] * texelFetch(low_x_coc, q, 0).r;
    }
}
