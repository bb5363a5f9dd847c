#version 450 core
#include <pass>

void main() {
    float time = float(frame.number) / (frame.fps > 0.0 ? frame.fps : 24.0);
    vec2 at = vec2(gl_FragCoord.x, float(frame.size.y) - gl_FragCoord.y) / vec2(frame.size) * param.scale;
    float wave = sin(at.x + time) + sin(at.y * 1.3 - time) + sin(length(at - 0.5 * param.scale) * 2.0);
    out_display = clamp(vec4(0.5 + 0.5 * cos(wave + vec3(0.0, 2.1, 4.2)), 1.0), 0.0, 1.0);
}
