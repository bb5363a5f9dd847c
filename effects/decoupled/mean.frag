#version 450 core
#include <pass>

void main() {
    ivec2 last = ivec2(color_size.xy) - 1, corner = 8 * ivec2(gl_FragCoord.xy);
    float sum = 0.0;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) sum += dot(texelFetch(color, min(corner + ivec2(x, y), last), 0).rgb, vec3(1.0));
    out_mean = sum / 64.0;
}
