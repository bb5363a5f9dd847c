// How many samples a pixel takes.
#include <burley.glsl>
#include <scattering/facet.glsl>
#include <hash.glsl>
#include "past.glsl"

const float kProbeChance = 0.125;
const int kProbeSamples = 4;

float wanted_samples(float mean_count, float variance) {
    float excess = variance / param.target_variance;
#if CONTROLLER == CONTROLLER_RATIO
    return mean_count * excess;
#elif CONTROLLER == CONTROLLER_SQRT
    return mean_count * sqrt(excess);
#else
    // The moving average of weight a has the variance of a mean of 2 / a - 1 frames.
    return mean_count * (1.0 + (2.0 / param.history_weight - 1.0) * (excess - 1.0));
#endif
}

// The texture plan's texel of a pixel that scatters.
vec4 planned(ViewLines lines, Facet here) {
    ivec2 q;
    bool inside = past_pixel(q);
    vec4 past = texelFetch(history_prev, q, 0);
    bool known = inside && past.a == key_of(here.key);
    float most = float(param.max_samples), least = min(float(param.min_samples), most);
    // Without history the wanted variance is taken to be met.
    bool counted = known && past.x >= 0.0;
    float mean_count = counted ? past.x : 0.5 * (least + most);
    float variance = counted ? past.y * past.y : param.target_variance;
    // A count of 0 would stay 0, whatever the variance.
    float wanted = wanted_samples(max(mean_count, 0.5), variance);
    // One of 4 x 4 px, which a processor draws together: all wait for the one that takes most.
    uvec2 block = uvec2(floor((gl_FragCoord.xy + vec2(frame.origin)) / frame.scale)) / 4u;
    uvec3 hash = pcg3d(uvec3(block, pcg3d(uvec3(frame.number, frame.step_seed, param.seed + 65536)).x));
    float count = floor(clamp(wanted, least, most) + unit_float(hash.x));
#if CONTROL_VARIATE != CONTROL_VARIATE_NONE
    // A pixel that takes none learns nothing of what changed.
    if (count < 0.5 && unit_float(hash.y) < kProbeChance) count = float(kProbeSamples);
#endif
    vec3 d = scattering_profile(here.key - 1u).d;
    float leaving = burley_beyond(0.5 / pixels_per_mm(lines, here.depth_m), max(d.r, max(d.g, d.b)));
#if DISTANT_FADE
    float scattered = clamp(leaving / max(param.distant_share, 1e-6) - 1.0, 0.0, 1.0);
#else
    float scattered = leaving > param.distant_share ? 1.0 : 0.0;
#endif
    if (param.distant_share == 0.0) scattered = 1.0;
    return vec4(scattered > 0.0 ? min(count, most) : 0.0, known ? 1.0 : 0.0, scattered, wanted);
}
