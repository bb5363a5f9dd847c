#version 450 core
#include <pass>
#include "blur.glsl"

#if COMBINE == COMBINE_MIN
vec4 combine(vec4 a, vec4 b) { return min(a, b); }
#else
vec4 combine(vec4 a, vec4 b) { return max(a, b); }
#endif

vec4 second_blur(usampler2D image, ivec2 p, float near_px, float degrees) {
    Light light = blur(image, p, near_px, make_line(degrees));
    return vec4(light.rgb, light.alpha);
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float near_px = texelFetch(near, p / kTile, 0).r;
    vec4 a = second_blur(first_a, p, near_px, second_degrees(0));
#if SHAPE == SHAPE_HEXAGON
    out_color = combine(a, second_blur(first_a, p, near_px, second_degrees(1)));
#elif SHAPE == SHAPE_OCTAGON
    out_color = combine(a, second_blur(first_b, p, near_px, second_degrees(1) + 45.0));
#else
    out_color = a;
#endif
}
