#version 450 core
#include <pass>

void main() {
    ivec2 last = ivec2(mean_size.xy) - 1, p = ivec2(gl_FragCoord.xy);
    float sum = 0.0, darkest = texelFetch(mean, p, 0).r;
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x) {
            float tap = texelFetch(mean, clamp(p + ivec2(x, y), ivec2(0), last), 0).r;
            sum += tap;
            darkest = min(darkest, tap);
        }
    out_surround = vec2(sum / 25.0, darkest);
}
