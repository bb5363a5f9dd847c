#version 450 core
#include <pass>
#include "lens.glsl"

// What does not depend on the pixel is computed here: software GL would compute it again for each, and fetch each parameter. One triangle
// covers the picture, as a strip of four vertices whose second triangle is empty.
layout(location = 0) flat out vec4 lens;  // radius at infinity, px; focus distance, m; least and greatest signed radius, px

void main() {
    lens = vec4(lens_at_infinity_px(), param.focus_distance, -param.max_coc_radius, param.max_coc_radius);
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID > 1 ? 3.0 : -1.0, 0.0, 1.0);
}
