#version 450 core
#include <pass>

// Mean light of 8 x 8 px; the host makes the wider means.
void main() {
    out_surroundings = vec4(0.0);
    ivec2 corner = ivec2(gl_FragCoord.xy) * 8, last = ivec2(color_size.xy) - 1;
    // From a place that varies: unrolled, as loops of constant bounds are, this took eight times as long to compile.
    ivec2 p = corner;
    do {
        p.x = corner.x;
        do {
            out_surroundings += texelFetch(color, min(p, last), 0) / 64.0;
        } while (++p.x < corner.x + 8);
    } while (++p.y < corner.y + 8);
}
