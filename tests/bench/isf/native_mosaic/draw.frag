#version 450 core
#include <pass>

void main() {
    vec2 from_bottom = vec2(gl_FragCoord.x, float(frame.size.y) - gl_FragCoord.y);
    vec2 middle = (floor(from_bottom / param.side) + 0.5) * param.side / vec2(frame.size);
    out_display = clamp(textureLod(display, vec2(middle.x, 1.0 - middle.y), 0.0), 0.0, 1.0);
}
