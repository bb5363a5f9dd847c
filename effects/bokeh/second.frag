#version 450 core
#include <pass>
#include "blur.glsl"
#include "combine.glsl"

vec4 second_blur(usampler2D image, ivec2 p, float near_px, int parallelogram) {
    Light light = blur(image, p, near_px, second_line(parallelogram));
    return light.color;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float near_px = texelFetch(near, p / kTile, 0).r;
    vec4 a = second_blur(first_a, p, near_px, 0);
#if SHAPE == SHAPE_HEXAGON
    out_color = combine(a, second_blur(first_a, p, near_px, 1));
#elif defined(HAS_FIRST_B)
    out_color = combine(a, second_blur(first_b, p, near_px, 1));
#else
    out_color = a;
#endif
}
