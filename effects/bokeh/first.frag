#version 450 core
#include <pass>
#include "blur.glsl"

layout(location = 0) flat in vec4 line_a;
#if SHAPE == SHAPE_OCTAGON || SHAPE == SHAPE_CUSTOM
layout(location = 1) flat in vec4 line_b;
#endif

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float near_px = texelFetch(near, p / kTile, 0).r;
#ifdef HAS_OUT_FRONT_A
    out_front_a = pack_light(blur(front, p, near_px, unpacked_line(line_a)));
#ifdef HAS_OUT_FRONT_B
    out_front_b = pack_light(blur(front, p, near_px, unpacked_line(line_b)));
#endif
    near_px = texelFetch(behind_near, p / kTile, 0).r;
#endif
    out_first_a = pack_light(blur(light, p, near_px, unpacked_line(line_a)));
#ifdef HAS_OUT_FIRST_B
    out_first_b = pack_light(blur(light, p, near_px, unpacked_line(line_b)));
#endif
}
