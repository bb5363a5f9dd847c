#version 450 core
#include <pass>

void main() {
    vec2 at = gl_FragCoord.xy / out_across_size.xy, along = vec2(2.0 / out_across_size.x, 0.0);
    vec4 sum = 0.3 * textureLod(display, at, 0.0);
    for (int i = 1; i < 4; ++i)
        sum += (0.175 - 0.05 * float(i - 1)) * (textureLod(display, at + float(i) * along, 0.0) + textureLod(display, at - float(i) * along, 0.0));
    out_across = sum;
}
