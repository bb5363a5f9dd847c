#version 450 core
#include <pass>
#include <coverage.glsl>

void main() {
    vec3 display = clamp(config(straight_light(color) * exp2(param.exposure)), 0.0, 1.0);
#ifdef CHANGES_GAMMA
    display = pow(display, vec3(1.0 / param.gamma));
#endif
    out_display = vec4(display, clamp(color.a, 0.0, 1.0));
}
