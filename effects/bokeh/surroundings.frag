#version 450 core
#include <pass>

// Mean light of 8 x 8 px; the host makes the wider means.
void main() {
    out_surroundings = vec4(0.0);
    if (param.highlight_gain == 0.0) return;
    ivec2 corner = ivec2(gl_FragCoord.xy) * 8, last = ivec2(color_size.xy) - 1;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) out_surroundings += texelFetch(color, min(corner + ivec2(x, y), last), 0) / 64.0;
}
