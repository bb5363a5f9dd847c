#version 450 core
#include <pass>

// Sums of the rows before the texel, as parts of the outline's height.
void main() {
    vec3 sum = vec3(0.0), lost = vec3(0.0);  // Kahan's summation
    for (int row = 0; row < int(gl_FragCoord.x); ++row) {
        precise vec3 term = texelFetch(edge, ivec2(row, 0), 0).rgb - lost;
        precise vec3 next = sum + term;
        lost = (next - sum) - term;
        sum = next;
    }
    out_outline = vec4(sum * (2.0 / edge_size.x), 0.0);
}
