#version 450 core
#include <pass>
#include "grain_place.glsl"
#include "one_grain.glsl"

flat out uvec3 key;

// A quad over the grains that the frame has.
void main() {
    vec2 grains_size = ceil(1.25 * vec2(frame.size));
    ivec2 count = min(last_grain() - first_grain() + 1, ivec2(grains_size));
    vec2 corner = vec2(count) * vec2(gl_VertexID & 1, gl_VertexID >> 1) / grains_size;
    gl_Position = vec4(2.0 * corner.x - 1.0, 1.0 - 2.0 * corner.y, 0.0, 1.0);
    key = grain_key();
}
