#version 450 core
#include <pass>

void main() {
    vec4 color = texelFetch(display, ivec2(gl_FragCoord.xy), 0);
    vec3 light = max(textureLod(spread, gl_FragCoord.xy / vec2(frame.size), 0.0).rgb - 0.5, 0.0);
    out_display = clamp(vec4(color.rgb + param.amount * light, color.a), 0.0, 1.0);
}
