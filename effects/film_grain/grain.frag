#version 450 core
#include <pass>
#include <coverage.glsl>
#include <luminance.glsl>
#include "grain_place.glsl"
#include "grain_bits.glsl"

const float kMiddleGrey = 0.18;
// Luminances between which grain follows the light: a negative's toe and shoulder.
const float kDarkest = 0.002, kBrightest = 16.0;

// The nine nearest grains, weighted by a round bell that ends at 1.5 grains and divided by the root of the sum of squared
// weights, so that every pixel has a variance of 1 wherever it lies between them.
float bell_at(vec2 away) {
    float bell = max(1.0 - dot(away, away) / (1.5 * 1.5), 0.0);
    return bell * bell * bell * bell;
}

// The sampler takes the texel whose centre a place is, or the edge's, which pictures of four pixels or fewer need, whose textures are
// too small: on llvmpipe faster than texelFetch() with a bound.
uvec2 bits_at(vec2 place) {
#if MONOCHROME
    return uvec2(textureLod(grains, place, 0.0).r, 0);
#else
    return uvec2(textureLod(grains, place, 0.0).r, textureLod(grains_blue, place, 0.0).r);
#endif
}

vec3 grain(ivec2 p) {
    ivec2 nearest = nearest_grain(p);
    vec2 away = grain_place(p) - vec2(nearest), centre = vec2(nearest - first_grain()) + 0.5;
    vec3 codes = vec3(0.0);
    float weights = 0.0, squares = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            float weight = bell_at(away - vec2(x, y));
            codes += weight * grain_codes(bits_at((centre + vec2(x, y)) * grains_size.zw));
            weights += weight;
            squares += weight * weight;
        }
    return grain_of_codes(codes, weights) * inversesqrt(squares);
}

void main() {
    if (param.intensity == 0.0) {
        out_color = color;
        return;
    }
    vec3 light = straight_light(color);
    float level = clamp(luminance(frame.rec709_from_color * light), kDarkest, kBrightest);
    // 1 / size^2 grains in a pixel leave `size` of their deviation.
    float deviation = param.intensity * min(param.size, 1.0) * pow(level / kMiddleGrey, -param.response);
    vec3 gain = exp(deviation * grain(ivec2(gl_FragCoord.xy)) - 0.5 * deviation * deviation);
    out_color = vec4(color.rgb * gain, color.a);
}
