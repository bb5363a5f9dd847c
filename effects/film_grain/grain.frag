#version 450 core
#include <pass>
#include <hash.glsl>
#include <luminance.glsl>

const float kMiddleGrey = 0.18;
// Luminances between which grain follows the light: a negative's toe and shoulder.
const float kDarkest = 0.002, kBrightest = 16.0;

// Standard normal numbers of one grain, which has its place in the display window.
vec3 grain_at(ivec2 cell) {
    uvec3 key = pcg3d(uvec3(uint(frame.number), frame.step_seed, uint(param.seed)));
    uvec3 a = pcg3d(uvec3(uvec2(cell), key.x));
#if MONOCHROME
    return vec3(normal_pair(a.x, a.y).x);
#else
    uvec3 b = pcg3d(uvec3(uvec2(cell), key.y));
    return vec3(normal_pair(a.x, a.y), normal_pair(a.z, b.x).x);
#endif
}

// The nine nearest grains, weighted by a round bell that ends at 1.5 grains and divided by the root of the sum of squared
// weights, so that every pixel has a variance of 1 wherever it lies between them.
vec3 grain(vec2 display_px) {
    vec2 place = display_px / max(param.size, 1.0);
    ivec2 nearest = ivec2(floor(place + 0.5));
    vec3 sum = vec3(0.0);
    float squares = 0.0;
    for (int i = 0; i < 9; ++i) {
        ivec2 cell = nearest + ivec2(i % 3, i / 3) - 1;
        vec2 away = place - vec2(cell);
        float bell = max(1.0 - dot(away, away) / (1.5 * 1.5), 0.0);
        float weight = bell * bell * bell * bell;
        if (weight > 0.0) sum += weight * grain_at(cell);
        squares += weight * weight;
    }
    return sum * inversesqrt(squares);
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    if (param.intensity == 0.0) {
        out_color = color;
        return;
    }
    vec3 light = color.a > 0.0 ? color.rgb / color.a : color.rgb;
    float level = clamp(luminance(frame.rec709_from_color * light), kDarkest, kBrightest);
    // 1 / size^2 grains in a pixel leave `size` of their deviation.
    float deviation = param.intensity * min(param.size, 1.0) * pow(level / kMiddleGrey, -param.response);
    vec3 gain = exp(deviation * grain(vec2(p + frame.origin)) - 0.5 * deviation * deviation);
    out_color = vec4(color.rgb * gain, color.a);
}
