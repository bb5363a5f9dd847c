#version 450 core
#include <pass>

vec4 at(vec2 offset) { return textureLod(display, (gl_FragCoord.xy + offset) / vec2(frame.size), 0.0); }

void main() {
    vec4 color = at(vec2(0.0));
    vec4 around = at(vec2(-1.0, 0.0)) + at(vec2(1.0, 0.0)) + at(vec2(0.0, -1.0)) + at(vec2(0.0, 1.0));
    out_display = clamp(color + param.amount * (color - 0.25 * around), 0.0, 1.0);
}
