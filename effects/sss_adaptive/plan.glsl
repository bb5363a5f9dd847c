// How many samples a pixel takes.
#include <burley.glsl>
#include <scattering/facet.glsl>
#include "epoch.glsl"
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

// What is decided of a pixel before it is sampled.
struct Plan {
    float count;      // samples to take
    bool known;       // whether the frame before showed this surface
    float scattered;  // share of the scattered light in the result
    float wanted;     // samples wanted, before rounding and the limits
    float each;       // the texture epoch
};

// Of a pixel that scatters, whose history is `past` if it is `inside`; past_each: of the texture epoch.
Plan planned(ViewLines lines, Facet here, bool inside, vec4 past, float past_each) {
    bool known = inside && past.a == key_of(here.key);
    float most = float(param.max_samples), least = min(float(param.min_samples), most);
    // Without history the wanted variance is taken to be met.
    float mean_count = known ? past.x : 0.5 * (least + most);
    float variance = known ? past.y * past.y : param.target_variance;
    // A count of 0 would stay 0, whatever the variance.
    float wanted = wanted_samples(max(mean_count, 0.5), variance);
    float each = !known ? 0.0 : frame_of_epoch() == 0 ? max(clamp(wanted, least, most), 1e-6) : past_each;
    uvec3 hash = block_hash(uint(frame.number));
    float count = floor(clamp(wanted, least, most) + unit_float(hash.x));
    if (each > 0.0) count = taken_before(each, frame_of_epoch() + 1) - taken_before(each, frame_of_epoch());
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
    return Plan(scattered > 0.0 ? min(count, most) : 0.0, known, scattered, wanted, each);
}
