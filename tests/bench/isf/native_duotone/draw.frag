#version 450 core
#include <pass>

void main() {
    float luminance = dot(display.rgb, vec3(0.2126, 0.7152, 0.0722));
    vec3 tone = mix(param.dark.rgb, param.light.rgb, smoothstep(0.0, 1.0, luminance));
    out_display = clamp(vec4(tone, display.a), 0.0, 1.0);
}
