#version 450 core
#include <pass>

vec4 tap(float x, float y) {
    return textureLod(FINER, (2.0 * gl_FragCoord.xy + vec2(x, y)) * FINER_SIZE.zw, 0.0);
}

// Jimenez 2014: five overlapping boxes of four taps; the middle one counts a half.
void main() {
    vec4 inner = tap(-1, -1) + tap(1, -1) + tap(-1, 1) + tap(1, 1);
    vec4 corners = tap(-2, -2) + tap(2, -2) + tap(-2, 2) + tap(2, 2);
    vec4 sides = tap(0, -2) + tap(-2, 0) + tap(2, 0) + tap(0, 2);
    OUT = 0.125 * (inner + tap(0, 0)) + 0.0625 * sides + 0.03125 * corners;
}
