#version 450 core
#include <pass>

void main() {
    ivec2 last = ivec2(mean_size.xy) - 1, p = ivec2(gl_FragCoord.xy);
    vec2 sum = vec2(0.0), darkest = texelFetch(mean, p, 0).rg;
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x) {
            vec2 tap = texelFetch(mean, clamp(p + ivec2(x, y), ivec2(0), last), 0).rg;
            sum += tap;
            darkest = min(darkest, tap);
        }
    out_surround = vec4(sum.x / 25.0, darkest.x, sum.y / 25.0, darkest.y);
}
