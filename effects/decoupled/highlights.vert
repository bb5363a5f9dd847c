#version 450 core
#include <pass>
#include "surfel.glsl"

flat out ivec2 source;

// A quad over all that a highlight reaches.
void main() {
    uint place = highlight_list[gl_InstanceID];
    source = ivec2(place & 65535u, place >> 16u);
    vec4 path = path_at(source);
    float lens_px = abs(texelFetch(coc, source, 0).r) + 1.0;
    vec2 opens = way_px(path, kOpens), middle = way_px(path, kOpens + 0.5), closes = way_px(path, kOpens + 1.0);
    vec2 low = min(min(opens, middle), closes) - lens_px, high = max(max(opens, middle), closes) + lens_px;
    vec2 corner = vec2(source) + 0.5 + mix(low, high, vec2(gl_VertexID & 1, gl_VertexID >> 1));
    gl_Position = vec4(2.0 * corner.x / float(frame.size.x) - 1.0, 1.0 - 2.0 * corner.y / float(frame.size.y), 0.0, 1.0);
}
