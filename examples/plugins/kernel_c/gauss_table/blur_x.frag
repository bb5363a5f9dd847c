#version 450 core
#include <pass>
void main() {
    ivec2 last = ivec2(color_size.xy) - 1;
    vec4 sum = vec4(0.0);
    for (int i = -native.radius; i <= native.radius; ++i) {
        ivec2 at = clamp(ivec2(gl_FragCoord.xy) + ivec2(i, 0), ivec2(0), last);
        sum += texelFetch(kernel, ivec2(i + native.radius, 0), 0).r * texelFetch(color, at, 0);
    }
    out_rows = sum;
}
