#version 450 core
#include <pass>
#include <lens/packing.glsl>
#include "highlights.glsl"
#include <lens/own.glsl>

layout(location = 0) flat out vec2 source;
layout(location = 1) flat out vec3 highlight;
layout(location = 2) flat out float source_coc;

// A pixel at the rim of a light has less of its light than those inside, and has it on their side: where the middle of that part
// is, from the pixel's centre, px.
vec2 middle_of_light(ivec2 p, float coc_px) {
    float own = dot(own_color(p).rgb, vec3(1.0)), brightest = own;
    vec2 side = vec2(0.0);
    for (int i = 0; i < 9; ++i) {
        ivec2 to = ivec2(i % 3, i / 3) - 1, q = clamp(p + to, ivec2(0), frame.size - 1);
        if (abs(texelFetch(lit_coc, q, 0).r - coc_px) > 1.0) continue;
        float amount = dot(own_color(q).rgb, vec3(1.0));
        brightest = max(brightest, amount);
        side += amount * vec2(to);
    }
    return brightest > 0.0 && dot(side, side) > 0.0 ? 0.5 * (1.0 - own / brightest) * normalize(side) : vec2(0.0);
}

void main() {
    uint place = highlight_list[gl_InstanceID];
    ivec2 p = highlight_place(place);
    source = vec2(p) + 0.5;
    source_coc = texelFetch(lit_coc, p, 0).r;
    source += middle_of_light(p, source_coc);
    highlight = own_color(p).rgb - unpack_light(texelFetch(light, p, 0)).color.rgb;
#ifdef HAS_HIDDEN_HIGHLIGHT
    if (is_hidden(place)) {
        source = vec2(p) + 0.5;
        source_coc = unpack_light(texelFetch(plate, p, 0)).coc;
        highlight = texelFetch(hidden_highlight, p, 0).rgb;
    }
#endif
    float reach_px = abs(source_coc) + 1.0;
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    vec2 at = source + reach_px * corner;
    gl_Position = vec4(2.0 * at.x / float(frame.size.x) - 1.0, 1.0 - 2.0 * at.y / float(frame.size.y), 0.0, 1.0);
}
