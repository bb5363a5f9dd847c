#version 450 core
#include <pass>

void main() {
    vec2 at = gl_FragCoord.xy / out_spread_size.xy, along = vec2(0.0, 2.0 / out_spread_size.y);
    vec4 sum = 0.3 * textureLod(across, at, 0.0);
    for (int i = 1; i < 4; ++i)
        sum += (0.175 - 0.05 * float(i - 1)) * (textureLod(across, at + float(i) * along, 0.0) + textureLod(across, at - float(i) * along, 0.0));
    out_spread = sum;
}
