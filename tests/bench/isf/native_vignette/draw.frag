#version 450 core
#include <pass>

void main() {
    vec2 from_center = gl_FragCoord.xy / vec2(frame.size) - 0.5;
    float light = 1.0 - smoothstep(0.3 * param.radius, param.radius, length(from_center));
    vec4 color = textureLod(display, gl_FragCoord.xy / vec2(frame.size), 0.0);
    out_display = clamp(vec4(color.rgb * light, color.a), 0.0, 1.0);
}
