#version 450 core
#include <pass>
#include "outline.glsl"

layout(location = 0) flat in vec2 source;
layout(location = 1) flat in vec3 light_of_source;
layout(location = 2) flat in float source_coc;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    prepare_outline_at(source);
    float pixel_coc = texelFetch(lit_coc, p, 0).r, radius_px = abs(source_coc);
    vec2 seen = texelFetch(veil, p, 0).rg;
    float front = clamp(pixel_coc - source_coc, 0.0, 1.0), behind = clamp(source_coc - pixel_coc, 0.0, 1.0);
    float through = front + (1.0 - front - behind) * seen.x + behind * seen.y;
    float density = cover(radius_px, gauge(vec2(p) + 0.5 - source, source_coc)) / spread_area(radius_px);
    out_color = vec4(through * density * light_of_source, 0.0);
}
