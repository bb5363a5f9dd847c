#version 450 core
#include <pass>

layout(location = 0) flat out ivec2 source;

void main() {
    uint place = highlight_list[gl_InstanceID];
    source = ivec2(place & 0xffffu, place >> 16);
    float reach_px = abs(texelFetch(coc, source, 0).r) + 1.0;
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    vec2 p = vec2(source) + 0.5 + reach_px * corner;
    gl_Position = vec4(2.0 * p.x / float(frame.size.x) - 1.0, 1.0 - 2.0 * p.y / float(frame.size.y), 0.0, 1.0);
}
