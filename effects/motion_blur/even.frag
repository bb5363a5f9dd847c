#version 450 core
#include <pass>
#include "taps.glsl"

// All around moves alike, so nothing hides anything else: the mean along the pixel's own path. A filtered look-up between two texels is the
// mean of both, so one does for two px of the sweep, counted along the axis where it is longer: the cuts between them are texels' borders.
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec2 point = vec2(p) + 0.5;
    vec4 path = path_of(p), sum = vec4(0.0);
    vec2 sweep = path.xy + path.zw * (kOpens + kCloses), opens = way_px(path, kOpens);
    bool is_level = abs(sweep.x) >= abs(sweep.y);
    float along = is_level ? sweep.x : sweep.y, first = is_level ? opens.x : opens.y;
    float length_px = max(abs(along), 1e-3), each_px = 1.0 / length_px;
    float step_px = max(2.0, length_px / float(param.samples)), shift_px = tap_shift(0.5 * step_px) * step_px;
    float start_px = 0.0, end_px = 2.0 - fract(0.5 + (along < 0.0 ? -first : first));
    do {
        end_px = min(end_px, length_px);
        float t = kOpens + (0.5 * (start_px + end_px) + shift_px) * each_px;
        sum += (end_px - start_px) * each_px * color_at(point - way_px(path, t));
        start_px = end_px;
        end_px += step_px;
    } while (start_px < length_px);
    out_color = sum;
}
