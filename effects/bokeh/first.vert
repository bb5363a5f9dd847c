#version 450 core
#include <pass>
#include <full_screen.glsl>
#include "line.glsl"

// The lines are the same for all pixels: software GL would compute them again for each.
layout(location = 0) flat out vec4 line_a;
#if SHAPE == SHAPE_OCTAGON || SHAPE == SHAPE_CUSTOM
layout(location = 1) flat out vec4 line_b;
#endif

void main() {
    line_a = packed_line(first_line(0));
#if SHAPE == SHAPE_OCTAGON || SHAPE == SHAPE_CUSTOM
    line_b = packed_line(first_line(1));
#endif
    gl_Position = full_screen_corner();
}
