#version 450 core
#include <pass>
#include "tile.glsl"

layout(location = 0) flat out uint tile_index;

// A quad over one tile of the list, as a strip of four corners.
void main() {
    tile_index = LIST[gl_InstanceID];
    ivec2 corner = ivec2(gl_VertexID & 1, gl_VertexID >> 1);
    vec2 p = vec2(min((tile_of_number(tile_index) + corner) * kTile, frame.size));
    vec2 ndc = 2.0 * p / vec2(frame.size) - 1.0;
    gl_Position = vec4(ndc.x, -ndc.y, 0.0, 1.0);  // pixels count down, NDC up
}
