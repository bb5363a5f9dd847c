#version 450 core
#include <pass>

void main() {
    vec3 light = (display.rgb * param.gain - 0.5) * param.contrast + 0.5;
    out_display = clamp(vec4(light, display.a), 0.0, 1.0);
}
