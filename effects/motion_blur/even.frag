#version 450 core
#include <pass>
#include "taps.glsl"

// All around moves alike, so nothing hides anything else: the mean along the pixel's own path, of which one look-up does for two parts,
// between the middles of both by how much of them is in the exposure.
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec2 point = vec2(p) + 0.5;
    vec4 path = path_of(p), sum = vec4(0.0);
    Parts parts = parts_of(path, 2 * param.samples);
    float from_px = 0.0, border_px = parts.first_px + parts.step_px;
    do {
        float to_px = min(border_px + parts.step_px, parts.length_px), all_px = to_px - from_px, cut_px = min(border_px, to_px);
        float place_px = border_px + 0.5 * parts.step_px * (to_px + from_px - 2.0 * cut_px) / all_px;
        sum += all_px * color_at(point - way_px(path, part_time(parts, place_px)));
        from_px = to_px;
        border_px += 2.0 * parts.step_px;
    } while (from_px < parts.length_px);
    out_color = sum * parts.each_px;
}
