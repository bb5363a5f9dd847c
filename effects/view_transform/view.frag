#version 450 core
#include <pass>
#include <coverage.glsl>
#include <srgb.glsl>

#if TRANSFORM == TRANSFORM_ACES
// Matrices written by columns, as GLSL reads them.
const mat3 kAcesInput = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
const mat3 kAcesOutput =
    mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);

vec3 transform(vec3 light) {
    vec3 v = kAcesInput * light;
    vec3 fitted = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return encode_srgb(clamp(kAcesOutput * fitted, 0.0, 1.0));
}
#elif TRANSFORM == TRANSFORM_AGX
const mat3 kAgxInset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051,   //
                            0.0784335999999992, 0.878468636469772, 0.0784336,            //
                            0.0792237451477643, 0.0791661274605434, 0.879142973793104);
const mat3 kAgxOutset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438,   //
                             -0.0980208811401368, 1.15190312990417, -0.0980434501171241,   //
                             -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
// Stops around middle grey that the curve covers.
const float kAgxMinEv = -12.47393, kAgxMaxEv = 4.026069;

vec3 transform(vec3 light) {
    vec3 stops = log2(max(kAgxInset * light, 1e-10));
    vec3 x = (clamp(stops, kAgxMinEv, kAgxMaxEv) - kAgxMinEv) / (kAgxMaxEv - kAgxMinEv);
    vec3 x2 = x * x, x4 = x2 * x2;
    // From 26 on, Mesa adds a constant at a sum's end earlier; at its front it stays, and so do the bits.
    vec3 curve =
        -(0.00232 - (15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x));
    return kAgxOutset * curve;  // already encoded for a 2.2 display
}
#else
vec3 transform(vec3 light) { return encode_srgb(light); }
#endif

void main() {
    // A tone curve is not linear, so it is for the colour itself, not for the colour times its coverage.
    vec3 rec709 = max(frame.rec709_from_color * straight_light(color), 0.0) * exp2(param.exposure);
    out_display = vec4(clamp(transform(rec709), 0.0, 1.0), clamp(color.a, 0.0, 1.0));
}
