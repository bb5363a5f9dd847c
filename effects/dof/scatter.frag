#version 450 core
#include <pass>
#include <lens/packing.glsl>
#include "outline.glsl"

layout(location = 0) flat in ivec2 source;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    prepare_outline_at(vec2(source) + 0.5);
    float source_coc = texelFetch(coc, source, 0).r, pixel_coc = texelFetch(coc, p, 0).r, radius_px = abs(source_coc);
    vec2 seen = texelFetch(veil, p, 0).rg;
    float front = clamp(pixel_coc - source_coc, 0.0, 1.0), behind = clamp(source_coc - pixel_coc, 0.0, 1.0);
    float through = front + (1.0 - front - behind) * seen.x + behind * seen.y;
    vec3 highlight = texelFetch(color, source, 0).rgb - unpack_light(texelFetch(light, source, 0)).color.rgb;
    float density = cover(radius_px, gauge(vec2(p - source), source_coc)) / spread_area(radius_px);
    out_color = vec4(through * density * highlight, 0.0);
}
