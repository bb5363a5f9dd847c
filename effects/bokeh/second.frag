#version 450 core
#include <pass>
#include "blur.glsl"
#include "combine.glsl"

vec4 second_blur(usampler2D image, ivec2 p, float near_px, int parallelogram) {
    return blur(image, p, near_px, second_line(parallelogram)).color;
}

// `a`, `b`: blurred along the first direction of each parallelogram.
vec4 polygon_of(usampler2D a, usampler2D b, ivec2 p, float near_px) {
#if SHAPE == SHAPE_HEXAGON
    // Both from one image, in a loop: a second copy of the blur takes as long to compile as the first. It begins at 0, which no
    // compiler knows, or it would be unrolled.
    vec4 both = vec4(0.0);
    int i = near_px < 0.0 ? 1 : 0;
    do {
        vec4 one = second_blur(a, p, near_px, i);
        both = i == 0 ? one : combine(both, one);
    } while (++i < 2);
    return both;
#elif defined(HAS_FIRST_B)
    return combine(second_blur(a, p, near_px, 0), second_blur(b, p, near_px, 1));
#else
    return second_blur(a, p, near_px, 0);
#endif
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float near_px = texelFetch(near, p / kTile, 0).r;
    vec4 over = vec4(0.0);
#if defined(HAS_FRONT_B)
    over = polygon_of(front_a, front_b, p, near_px);
#elif defined(HAS_FRONT_A)
    over = polygon_of(front_a, front_a, p, near_px);
#endif
#ifdef HAS_FRONT_A
    near_px = texelFetch(behind_near, p / kTile, 0).r;
#endif
#ifdef HAS_FIRST_B
    out_color = polygon_of(first_a, first_b, p, near_px);
#else
    out_color = polygon_of(first_a, first_a, p, near_px);
#endif
#ifdef HAS_FRONT_A
    out_color = over + (1.0 - over.a) * out_color;
#endif
}
