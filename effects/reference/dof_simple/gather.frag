#version 450 core
#include <pass>
#include "poisson.glsl"

struct Tap {
    vec4 light;   // premultiplied RGB, alpha
    float coc;    // what the weights take for the tap's depth: it grows with it
    float blur;   // 0 in focus, 1 at the largest CoC
};

float blur_of(float radius) { return min(abs(radius) / param.max_coc_radius, 1.0); }

// Taps of the full picture are single texels: filtering would mix the CoC of both sides of a silhouette.
Tap fetch(vec2 offset, float radius) {
    ivec2 p = clamp(ivec2(floor(gl_FragCoord.xy + radius * offset)), ivec2(0), ivec2(color_size.xy) - 1);
    Tap tap;
    tap.light = texelFetch(color, p, 0);
    tap.coc = texelFetch(coc, p, 0).r;
    tap.blur = blur_of(tap.coc);
#if LOW_RESOLUTION
    vec2 at = (gl_FragCoord.xy / 4.0 + param.low_radius * radius * offset) * low_size.zw;
    tap.light = mix(tap.light, texture(low, at), tap.blur);
#if WEIGHTS == WEIGHTS_SCHEUERMANN
    tap.coc = mix(tap.coc, texture(low_coc, at).r, tap.blur);
    tap.blur = blur_of(tap.coc);
#endif
#endif
    return tap;
}

// How much a tap may leak: what lies in front of the centre counts by its own blur, so that the sharp does not smear over
// what is blurred behind it.
float weight(Tap tap, float centre_coc) {
#if WEIGHTS == WEIGHTS_RIGUER
    return tap.coc > centre_coc ? 1.0 : tap.blur;
#else
    return tap.coc >= centre_coc ? 1.0 : tap.blur;
#endif
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_color = texelFetch(color, p, 0);
    float centre_coc = texelFetch(coc, p, 0).r;
    if (abs(centre_coc) < 0.5) return;
    Tap centre = fetch(vec2(0.0), 0.0);
#if WEIGHTS == WEIGHTS_RIGUER
    float sum = 1.0;
#else
    float sum = weight(centre, centre_coc);
#endif
    vec4 light = sum * centre.light;
    for (int i = 0; i < param.taps; ++i) {
        Tap tap = fetch(kPoisson[i], abs(centre_coc));
        float amount = weight(tap, centre_coc);
        light += amount * tap.light;
        sum += amount;
    }
    // Every tap may lie in front and in focus.
    if (sum > 1e-4) out_color = light / sum;
}
