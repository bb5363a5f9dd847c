#version 450 core
#include <pass>
#include <aperture.glsl>

// A highlight outshines its surroundings this many times, and its light, spread over its CoC, still adds this fraction of them.
const float kOutshines = 4.0, kVisible = 0.02;
const float kLeastRadiusPx = 1.5;

// The share of a pixel's light that is its highlight: what lies above the darkest part of its surroundings, fading in so that
// nothing flickers. Visibility samples would miss most of a highlight that few pixels hold.
float highlight_share(float amount, vec2 around_amount, float radius_px) {
    if (radius_px < kLeastRadiusPx) return 0.0;
    float area = make_aperture(param.blades, param.curvature, 0.0).area * radius_px * radius_px;
    float bound = max(around_amount.x, 0.0) * max(kOutshines, kVisible * area);
    if (amount <= bound) return 0.0;
    return smoothstep(1.0, 2.0, amount / max(bound, 1e-30)) * (amount - clamp(around_amount.y, 0.0, amount)) / amount;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 texel = texelFetch(color, p, 0);
    texel.rgb *= 1.0 - highlight_share(dot(texel.rgb, vec3(1.0)), texelFetch(surround, p / 8, 0).rg, abs(texelFetch(coc, p, 0).r));
    out_light = texel;
}
