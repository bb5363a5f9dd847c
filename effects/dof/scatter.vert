#version 450 core
#include <pass>
#include "highlights.glsl"
#include "patch_texels.glsl"

layout(location = 0) flat out vec2 source;
layout(location = 1) flat out vec3 light_of_source;
layout(location = 2) flat out float source_coc;

void main() {
    uint place = highlight_list[gl_InstanceID];
    ivec2 p = highlight_place(place);
    source_coc = texelFetch(lit_coc, p, 0).r;
    Highlight seen = unpack_highlight(texelFetch(highlight, p, 0));
    source = vec2(p) + 0.5 + seen.middle_px;
    light_of_source = seen.rgb;
#ifdef HAS_HIDDEN_HIGHLIGHT
    if (is_hidden(place)) {
        source = vec2(p) + 0.5;
        source_coc = unpack_plate(texelFetch(plate, p, 0)).coc;
        light_of_source = texelFetch(hidden_highlight, p, 0).rgb;
    }
#endif
    float reach_px = abs(source_coc) + 1.0;
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    vec2 at = source + reach_px * corner;
    gl_Position = vec4(2.0 * at.x / float(frame.size.x) - 1.0, 1.0 - 2.0 * at.y / float(frame.size.y), 0.0, 1.0);
}
