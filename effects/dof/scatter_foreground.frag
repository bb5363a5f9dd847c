#version 450 core
#include <pass>
#include "scattered.glsl"

void main() {
    out_foreground = vec4(density_before(ivec2(gl_FragCoord.xy)) * light_of_source, 0.0);
}
