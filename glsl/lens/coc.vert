#version 450 core
#include <pass>
#include "lens.glsl"

// What does not depend on the pixel is computed here: software GL would compute it again for each. One triangle covers the picture,
// as a strip of four vertices whose second triangle is empty.
layout(location = 0) flat out float at_infinity_px;

void main() {
    at_infinity_px = lens_at_infinity_px();
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID > 1 ? 3.0 : -1.0, 0.0, 1.0);
}
