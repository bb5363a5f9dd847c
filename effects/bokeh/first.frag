#version 450 core
#include <pass>
#include "blur.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float near_px = texelFetch(near, p / kTile, 0).r;
#ifdef HAS_OUT_FRONT_A
    out_front_a = pack_light(blur(front, p, near_px, first_line(0)));
#ifdef HAS_OUT_FRONT_B
    out_front_b = pack_light(blur(front, p, near_px, first_line(1)));
#endif
    near_px = texelFetch(behind_near, p / kTile, 0).r;
#endif
    out_first_a = pack_light(blur(light, p, near_px, first_line(0)));
#ifdef HAS_OUT_FIRST_B
    out_first_b = pack_light(blur(light, p, near_px, first_line(1)));
#endif
}
