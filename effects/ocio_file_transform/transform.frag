#version 450 core
#include <pass>
#include <coverage.glsl>

void main() {
    out_color = color;
#ifdef HAS_FILE
    out_color.rgb = file(straight_light(color)) * (has_coverage(color.a) ? color.a : 1.0);
#endif
}
