#version 450 core
#include <pass>
#include <coverage.glsl>

void main() {
    out_color = vec4(config(straight_light(color)) * (has_coverage(color.a) ? color.a : 1.0), color.a);
}
