#version 450 core
#include <pass>
#include "line.glsl"

// The lines are the same for all pixels: software GL would compute them again for each. One triangle covers the picture, as a strip of
// four vertices whose second triangle is empty.
layout(location = 0) flat out vec4 line_a;
#if SHAPE == SHAPE_OCTAGON || SHAPE == SHAPE_CUSTOM
layout(location = 1) flat out vec4 line_b;
#endif

void main() {
    line_a = packed_line(first_line(0));
#if SHAPE == SHAPE_OCTAGON || SHAPE == SHAPE_CUSTOM
    line_b = packed_line(first_line(1));
#endif
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID > 1 ? 3.0 : -1.0, 0.0, 1.0);
}
