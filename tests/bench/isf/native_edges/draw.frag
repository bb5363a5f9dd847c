#version 450 core
#include <pass>

float luminance(vec2 offset) {
    vec2 at = (gl_FragCoord.xy + offset) / vec2(frame.size);
    return dot(textureLod(display, at, 0.0).rgb, vec3(0.2126, 0.7152, 0.0722));
}

void main() {
    float nw = luminance(vec2(-1.0, -1.0)), n = luminance(vec2(0.0, -1.0)), ne = luminance(vec2(1.0, -1.0));
    float w = luminance(vec2(-1.0, 0.0)), e = luminance(vec2(1.0, 0.0));
    float sw = luminance(vec2(-1.0, 1.0)), s = luminance(vec2(0.0, 1.0)), se = luminance(vec2(1.0, 1.0));
    vec2 slope = vec2(ne + 2.0 * e + se - nw - 2.0 * w - sw, nw + 2.0 * n + ne - sw - 2.0 * s - se);
    out_display = clamp(vec4(vec3(param.strength * length(slope)), 1.0), 0.0, 1.0);
}
