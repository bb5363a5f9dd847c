#version 450 core
#include <pass>

void main() {
    ivec2 last = ivec2(mean_size.xy) - 1, p = ivec2(gl_FragCoord.xy);
    vec2 sum = vec2(0.0), darkest = texelFetch(mean, p, 0).rg;
    // From a place that varies, so that a compiler does not unroll it.
    ivec2 at = p - 2;
    do {
        at.x = p.x - 2;
        do {
            vec2 tap = texelFetch(mean, clamp(at, ivec2(0), last), 0).rg;
            sum += tap;
            darkest = min(darkest, tap);
        } while (++at.x <= p.x + 2);
    } while (++at.y <= p.y + 2);
    out_surround = vec4(sum.x / 25.0, darkest.x, sum.y / 25.0, darkest.y);
}
