// A letter's quad: `corner` of it, px of the display window, dots of `dot_px`.
#include <text.glsl>

layout(location = 0) flat out uvec2 dots;
layout(location = 1) flat out ivec4 place;  // its upper left corner in texels, and dot_px
layout(location = 2) flat out vec3 ink;

void no_letter() {
    dots = uvec2(0u);
    place = ivec4(0, 0, 1, 0);
    ink = vec3(0.0);
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0);
}

// `corner` in texels of the working grid.
void put_letter(uint letter, ivec2 corner, int dot_px, vec3 color) {
    dots = letter_dots(letter);
    place = ivec4(corner, dot_px, 0);
    ink = color;
    vec2 p = vec2(corner + ivec2(gl_VertexID & 1, gl_VertexID >> 1) * ivec2(kLetterWidth, kLetterHeight) * dot_px);
    gl_Position = vec4(2.0 * p.x / float(frame.size.x) - 1.0, 1.0 - 2.0 * p.y / float(frame.size.y), 0.0, 1.0);
}
