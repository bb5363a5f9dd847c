#version 450 core
#include <pass>
#include "taps.glsl"

// All around moves alike: nothing hides anything else.
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec2 point = vec2(p) + 0.5;
    vec4 path = motion_at(point).path, sum = vec4(0.0);
    int taps = tap_count(path);
    float shift = time_shift(path, taps);
    int i = 0;
    do sum += color_at(point - way_px(path, tap_time(i, shift, taps)));
    while (++i < taps);
    out_color = sum / float(taps);
}
