#version 450 core
#include <pass>

void main() {
    vec2 at = gl_FragCoord.xy / vec2(frame.size) - 0.5;
    float turn = -param.angle * smoothstep(0.5, 0.0, length(at));
    float c = cos(turn), s = sin(turn);
    vec2 from = vec2(c * at.x - s * at.y, s * at.x + c * at.y) + 0.5;
    out_display = clamp(textureLod(display, from, 0.0), 0.0, 1.0);
}
