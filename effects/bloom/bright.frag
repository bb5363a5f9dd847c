#version 450 core
#include <pass>
#include <luminance.glsl>
#include "bright.glsl"

// A texel lies over exactly two by two of the finer level, counted from the top left: the glow stays round
// and centred whatever the size. The 13 bilinear taps of Jimenez 2014 are five boxes of 4 x 4 texels; here
// each texel is fetched alone, because a bilinear tap would spread a NaN.
vec4 quads[5][5];

float quad_weight(vec4 quad) {
#if FIREFLIES == FIREFLIES_SOFTEN
    return 1.0 / (1.0 + max(luminance(quad.rgb), 0.0));
#else
    return 1.0;
#endif
}

// Four quads, two texels apart.
vec4 box_at(int x, int y) {
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec4 quad = quads[y + 2 * (i >> 1)][x + 2 * (i & 1)];
        sum += quad * quad_weight(quad);
        weights += quad_weight(quad);
    }
    return sum / weights;
}

void main() {
    ivec2 corner = 2 * ivec2(gl_FragCoord.xy) - 2, last = ivec2(color_size.xy) - 1;
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 5; ++x) quads[y][x] = vec4(0.0);
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 6; ++x) {
            ivec2 p = clamp(corner + ivec2(x, y), ivec2(0), last);
            vec4 light = 0.25 * bright_part(texelFetch(color, p, 0));
            for (int i = 0; i < 4; ++i) {
                ivec2 quad = ivec2(x - (i & 1), y - (i >> 1));
                if (quad.x >= 0 && quad.y >= 0 && quad.x < 5 && quad.y < 5) quads[quad.y][quad.x] += light;
            }
        }
    out_down_1 = 0.5 * box_at(1, 1) + 0.125 * (box_at(0, 0) + box_at(2, 0) + box_at(0, 2) + box_at(2, 2));
}
