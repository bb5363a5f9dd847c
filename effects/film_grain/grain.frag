#version 450 core
#include <pass>
#include <luminance.glsl>
#include "grain_place.glsl"
#include "grain_bytes.glsl"

const float kMiddleGrey = 0.18;
// Luminances between which grain follows the light: a negative's toe and shoulder.
const float kDarkest = 0.002, kBrightest = 16.0;

// The nine nearest grains, weighted by a round bell that ends at 1.5 grains and divided by the root of the sum of squared
// weights, so that every pixel has a variance of 1 wherever it lies between them.
float bell_at(vec2 away) {
    float bell = max(1.0 - dot(away, away) / (1.5 * 1.5), 0.0);
    return bell * bell * bell * bell;
}

vec3 grain(ivec2 p) {
    vec2 place = grain_place(p);
    // The bound is for pictures of four pixels or fewer, whose textures are too small.
    ivec2 nearest = nearest_grain(p), first = first_grain(), last = ivec2(grains_size.xy) - 1;
    vec3 high = vec3(0.0), low = vec3(0.0);
    float weights = 0.0, squares = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            float weight = bell_at(place - vec2(nearest + ivec2(x, y)));
            ivec2 texel = min(nearest + ivec2(x, y) - first, last);
            high += weight * texelFetch(grains, texel, 0).rgb;
            low += weight * texelFetch(grains_low, texel, 0).rgb;
            weights += weight;
            squares += weight * weight;
        }
    return grain_of_bytes(high, low, weights) * inversesqrt(squares);
}

void main() {
    if (param.intensity == 0.0) {
        out_color = color;
        return;
    }
    vec3 light = color.a > 0.0 ? color.rgb / color.a : color.rgb;
    float level = clamp(luminance(frame.rec709_from_color * light), kDarkest, kBrightest);
    // 1 / size^2 grains in a pixel leave `size` of their deviation.
    float deviation = param.intensity * min(param.size, 1.0) * pow(level / kMiddleGrey, -param.response);
    vec3 gain = exp(deviation * grain(ivec2(gl_FragCoord.xy)) - 0.5 * deviation * deviation);
    out_color = vec4(color.rgb * gain, color.a);
}
