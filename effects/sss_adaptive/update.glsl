// What a pixel that scatters keeps for the next frame.
#include <scattering/facet.glsl>
#include "moments.glsl"

// `value`: the frame's luminance; past: the texture history's texel of the frame before, known: of this surface. q: where
// it was.
void keep_moments(Facet here, ivec2 q, vec4 past, bool known, float count, float value) {
#if GUIDING
    // What the average is of: the blurred light has no noise, and moves with light and shadows.
    value -= viewed(texelFetch(blurred, ivec2(gl_FragCoord.xy), 0).rgb);
#if TARGET == TARGET_RELATIVE
    // Beside darkness light has no measure, and what it seems to be there would be remembered for dozens of frames.
    value = clamp(value, -1.0, 1.0);
#endif
#elif CONTROL_VARIATE == CONTROL_VARIATE_CONSTANT
    value -= viewed(here.light);
#elif CONTROL_VARIATE == CONTROL_VARIATE_ONLINE
    // The control variate's factor is what followed the light best so far, Cov / Var (Xie and Olano 2021), with the moving
    // covariance matrix of the luminance after and before scattering; 1 while that before has not changed yet.
    vec2 light = vec2(value, viewed(here.light));
    vec4 moments = known ? texelFetch(covariance_prev, q, 0) : vec4(0.0, 0.0, light);
    bool varied = moments.y > 1e-6 * (1.0 + moments.w * moments.w);
    float factor = varied ? clamp(moments.x / moments.y, 0.0, 2.0) : 1.0;
    vec2 off = light - moments.zw;
    float weight = param.history_weight;
    vec4 moved = vec4((1.0 - weight) * (moments.xy + weight * off * off.y), moments.zw + weight * off);
    out_covariance = count < 0.5 ? moments : moved;
    value -= factor * light.y;
#endif
    out_history = updated_history(past, known, count, value, here.key);
}

// Where nothing scatters.
void keep_nothing() {
    out_history = vec4(0.0);
#if GUIDING
    out_guided = vec4(0.0);
    out_guided_shares = uvec4(0u);
#elif CONTROL_VARIATE == CONTROL_VARIATE_ONLINE
    out_covariance = vec4(0.0);
#endif
}
