#version 450 core
#include <pass>
#include <aperture.glsl>
#include "layers.glsl"

const int kRows = 8;  // samples of a row of pixels
const int kSteps = 24;

// Where the outline, which is convex, crosses a row: no width where it does not.
vec2 crossing(Aperture aperture, float y, float radius) {
    float reach = abs(radius), low = -reach, high = reach;
    for (int i = 0; i < 2 * kSteps; ++i) {
        float a = mix(low, high, 0.375), b = mix(low, high, 0.625);
        if (aperture_gauge(aperture, vec2(a, y) / -radius) < aperture_gauge(aperture, vec2(b, y) / -radius)) high = b;
        else low = a;
    }
    float inner = 0.5 * (low + high);
    if (aperture_gauge(aperture, vec2(inner, y) / -radius) > 1.0) return vec2(0.0);
    vec2 inside = vec2(inner), outside = vec2(-reach, reach);
    for (int i = 0; i < kSteps; ++i)
        for (int side = 0; side < 2; ++side) {
            float x = 0.5 * (inside[side] + outside[side]);
            if (aperture_gauge(aperture, vec2(x, y) / -radius) <= 1.0) inside[side] = x;
            else outside[side] = x;
        }
    return inside;
}

// A pixel q lights p where (p - q) / CoC lies in the outline: the offsets q - p are the outline times minus the CoC.
void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    Layers layers = make_layers(texelFetch(range, ivec2(0), 0).rg);
    float radius = layer_radius(layers, texel.y);
    float y = float(texel.x) - 256.0;
    out_spans = vec4(0.0);
    if (radius == 0.0 || abs(y) > abs(radius) + 0.5) return;
    Aperture aperture = make_aperture(param.blades, param.curvature, radians(param.rotation));
    vec3 sum = vec3(0.0);
    for (int i = 0; i < kRows; ++i) {
        vec2 ends = crossing(aperture, y + (float(i) + 0.5) / float(kRows) - 0.5, radius);
        if (ends.y > ends.x) sum += vec3(ends, 1.0);
    }
    if (sum.z > 0.0) out_spans = vec4(sum.xy / sum.z, sum.z / float(kRows), 0.0);
}
