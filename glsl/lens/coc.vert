#version 450 core
#include <pass>
#include <full_screen.glsl>
#include "lens.glsl"

// What does not depend on the pixel is computed here: software GL would compute it again for each, and fetch each parameter.
layout(location = 0) flat out vec4 lens;  // radius at infinity, px; focus distance, m; least and greatest signed radius, px

void main() {
    lens = vec4(lens_at_infinity_px(), param.focus_distance, -param.max_coc_radius, param.max_coc_radius);
    gl_Position = full_screen_corner();
}
