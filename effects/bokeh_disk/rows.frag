#version 450 core
#include <pass>
#include "kernel.glsl"

struct Tap {
    vec4 color;  // times weight
    float weight;
};

Tap take(ivec2 p, float radius_px, int offset) {
    ivec2 texel = p + ivec2(offset, 0);
    if (texel.x < 0 || texel.x >= frame.size.x) return Tap(vec4(0.0), 0.0);
    Light tap = unpack_light(texelFetch(FIELD, texel, 0));
    float tap_radius = field_radius(tap.coc), distance_px = abs(float(offset));
    if (tap_radius <= 0.0) return Tap(vec4(0.0), 0.0);
    float weight = min(tap_radius, 1.0) * seen(tap_radius, radius_px, distance_px) * cover(radius_px, distance_px);
    return weight > 0.0 ? Tap(weight * tap.color, weight) : Tap(vec4(0.0), 0.0);
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 red_green[COMPONENTS], blue_alpha[COMPONENTS];
    vec2 weights[COMPONENTS];
    for (int i = 0; i < COMPONENTS; ++i) {
        red_green[i] = vec4(0.0);
        blue_alpha[i] = vec4(0.0);
        weights[i] = vec2(0.0);
    }
    vec4 reach_px = texelFetch(reach, p / kTile, 0);
    if ((NEAR == 1 ? reach_px.x : reach_px.y) >= kLeastBlurPx) {
        float radius_px = gather_radius(unpack_light(texelFetch(FIELD, p, 0)), reach_px);
        Walk walk = start_walk(radius_px);
        for (int n = 0; n <= int(ceil(radius_px - 0.5)); ++n) {
            Tap tap = take(p, radius_px, n);
            if (n > 0) {
                Tap other = take(p, radius_px, -n);
                tap = Tap(tap.color + other.color, tap.weight + other.weight);
            }
            for (int i = 0; i < COMPONENTS; ++i) {
                red_green[i] += vec4(tap.color.r * walk.k[i], tap.color.g * walk.k[i]);
                blue_alpha[i] += vec4(tap.color.b * walk.k[i], tap.color.a * walk.k[i]);
                weights[i] += tap.weight * walk.k[i];
            }
            step_on(walk);
        }
    }
    out_red_green_1 = red_green[0];
    out_blue_alpha_1 = blue_alpha[0];
#if COMPONENTS == 1
    out_weights_12 = vec4(weights[0], 0.0, 0.0);
#else
    out_red_green_2 = red_green[1];
    out_blue_alpha_2 = blue_alpha[1];
    out_weights_12 = vec4(weights[0], weights[1]);
#endif
#if COMPONENTS == 3
    out_red_green_3 = red_green[2];
    out_blue_alpha_3 = blue_alpha[2];
    out_weights_3 = weights[2];
#endif
}
