#version 450 core
#include <pass>
void main() {
    ivec2 last = ivec2(rows_size.xy) - 1;
    vec4 sum = vec4(0.0);
    for (int i = -native.radius; i <= native.radius; ++i) {
        ivec2 at = clamp(ivec2(gl_FragCoord.xy) + ivec2(0, i), ivec2(0), last);
        sum += texelFetch(kernel, ivec2(i + native.radius, 0), 0).r * texelFetch(rows, at, 0);
    }
    out_color = sum;
}
