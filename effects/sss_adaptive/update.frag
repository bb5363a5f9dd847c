#version 450 core
#include <pass>
#include <scattering/facet.glsl>
#include "moments.glsl"
#if GUIDING
#include "guide.glsl"
#endif

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), q;
    past_pixel(q);
    Facet here = read_facet(view_lines(), p);
    vec4 planned = texelFetch(plan, p, 0), drawn = texelFetch(estimate, p, 0), past = texelFetch(history_prev, q, 0);
    bool known = planned.y > 0.0 && past.x >= 0.0, followed = here.key != 0u && planned.y >= 0.0;
    float value = exposed(drawn.rgb);
#if CONTROL_VARIATE == CONTROL_VARIATE_CONSTANT
    value -= exposed(here.light);
#elif CONTROL_VARIATE == CONTROL_VARIATE_ONLINE
    // The control variate's factor is what followed the light best so far, Cov / Var (Xie and Olano 2021), with the moving
    // covariance matrix of the luminance after and before scattering; 1 while that before has not changed yet.
    vec2 light = vec2(value, exposed(here.light));
    vec4 moments = known ? texelFetch(covariance_prev, q, 0) : vec4(0.0, 0.0, light);
    bool varied = moments.y > 1e-6 * (1.0 + moments.w * moments.w);
    float factor = varied ? clamp(moments.x / moments.y, 0.0, 2.0) : 1.0;
    vec2 off = light - moments.zw;
    float weight = param.history_weight;
    vec4 moved = vec4((1.0 - weight) * (moments.xy + weight * off * off.y), moments.zw + weight * off);
    out_covariance = !followed ? vec4(0.0) : drawn.a < 0.5 ? moments : moved;
    value -= factor * light.y;
#endif
    vec4 after = updated_history(past, known, drawn.a, value, here.key);
    out_history = here.key == 0u ? vec4(0.0) : followed ? after : unsampled_history(here.key);
#if GUIDING
    Guided guided_now = guided_light(drawn.rgb, texelFetch(share, p, 0).rgb, here, planned.y > 0.0);
#ifdef HAS_BLURRED
    // What is blurred has no noise: samples that come to it later go on from there.
    if (texelFetch(sampled, p, 0).r == 0.0) {
        guided_now.light = vec4(texelFetch(blurred, p, 0).rgb, 1.0 / param.guiding_weight);
        guided_now.share = vec4(1.0);
    }
#endif
    bool scatters = here.key != 0u;
    out_guided = scatters ? guided_now.light : vec4(0.0);
    out_guided_share = scatters ? guided_now.share : vec4(0.0);
    out_lit = scatters ? guided_now.lit : vec4(0.0);
    out_lit_near = scatters ? guided_now.lit_near : 0.0;
#endif
}
