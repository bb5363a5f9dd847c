#version 450 core
#include <pass>

void main() {
    ivec2 last = ivec2(color_size.xy) - 1, corner = 8 * ivec2(gl_FragCoord.xy);
    float sum = 0.0;
    // From a place that varies: unrolled, as loops of constant bounds are, it took much longer to compile.
    ivec2 p = corner;
    do {
        p.x = corner.x;
        do {
            sum += dot(texelFetch(color, min(p, last), 0).rgb, vec3(1.0));
        } while (++p.x < corner.x + 8);
    } while (++p.y < corner.y + 8);
    out_mean = sum / 64.0;
}
