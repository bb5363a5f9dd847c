#version 450 core
#include <pass>
#include <text.glsl>

layout(location = 0) flat in uvec2 dots;
layout(location = 1) flat in ivec4 place;
layout(location = 2) flat in vec3 ink;

void main() {
    if (!has_dot(dots, (ivec2(gl_FragCoord.xy) - place.xy) / place.z)) discard;
    out_display = vec4(ink, 1.0);
}
