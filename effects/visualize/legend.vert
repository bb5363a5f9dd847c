#version 450 core
#include <pass>
#include "layout.glsl"

layout(location = 0) flat out ivec2 corner;

void main() {
    int faults = int(texelFetch(range, ivec2(0), 0).z);
    corner = panel_corner(faults);
    vec2 p = vec2(corner + ivec2(gl_VertexID & 1, gl_VertexID >> 1) * panel_size(faults) * unit_px());
    gl_Position = vec4(2.0 * p.x / float(frame.size.x) - 1.0, 1.0 - 2.0 * p.y / float(frame.size.y), 0.0, 1.0);
}
