#version 450 core
#include <pass>
#include <coverage.glsl>

void main() {
    vec3 display = clamp(config(straight_light(color) * exp2(param.exposure)), 0.0, 1.0);
    out_display = vec4(pow(display, vec3(1.0 / param.gamma)), clamp(color.a, 0.0, 1.0));
}
