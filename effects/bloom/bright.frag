#version 450 core
#include <pass>
#include <color_luminance.glsl>
#include "bright.glsl"

// A texel lies over exactly two by two of the finer level, counted from the top left: the glow stays round
// and centred whatever the size. The 13 bilinear taps of Jimenez 2014 are five boxes of 4 x 4 texels; here
// each texel is fetched alone, because a bilinear tap would spread a NaN.

float quad_weight(vec4 quad) {
#if FIREFLIES == FIREFLIES_SOFTEN
    return 1.0 / (1.0 + max(color_luminance(quad.rgb), 0.0));
#else
    return 1.0;
#endif
}

vec4 light_at(int x, int y) {
    ivec2 p = 2 * ivec2(gl_FragCoord.xy) - 2 + ivec2(x, y);
    return 0.25 * bright_part(texelFetch(color, clamp(p, ivec2(0), ivec2(color_size.xy) - 1), 0));
}

// Two by two texels from (x, y).
struct Quad {
    vec4 light;
    float weight;
};
Quad quad_at(int x, int y) {
    vec4 sum = light_at(x, y) + light_at(x + 1, y);
    sum += light_at(x, y + 1);
    sum += light_at(x + 1, y + 1);
    return Quad(sum, quad_weight(sum));
}

vec4 box(Quad a, Quad b, Quad c, Quad d) {
    vec4 sum = a.light * a.weight;
    sum += b.light * b.weight;
    sum += c.light * c.weight;
    sum += d.light * d.weight;
    return sum / (a.weight + b.weight + c.weight + d.weight);
}

// Written out: an array that a loop indexes lies in memory, which took four times as long on llvmpipe.
void main() {
    Quad middle = quad_at(2, 2);
    Quad top = quad_at(2, 0), left = quad_at(0, 2), right = quad_at(4, 2), bottom = quad_at(2, 4);
    vec4 inner = box(quad_at(1, 1), quad_at(3, 1), quad_at(1, 3), quad_at(3, 3));
    vec4 corners = box(quad_at(0, 0), top, left, middle) + box(top, quad_at(4, 0), middle, right);
    corners += box(left, middle, quad_at(0, 4), bottom);
    corners += box(middle, right, bottom, quad_at(4, 4));
    out_down_1 = 0.5 * inner + 0.125 * corners;
}
