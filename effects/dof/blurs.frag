#version 450 core
#include <pass>
#include "wide.glsl"

void main() {
    ivec2 tile = ivec2(gl_FragCoord.xy);
    out_blur_tile = vec2(0.0);
    out_plate_tile = vec4(0.0);
    if (!is_blurred(tile)) return;
    float wide = is_wide(tile) ? 1.0 : 0.0;
    vec2 of_plate = is_plated(tile) ? vec2(0.0, 1.0) : vec2(1.0, 0.0);
    out_blur_tile = vec2(1.0, wide);
    out_plate_tile = vec4(of_plate, wide * of_plate);
}
