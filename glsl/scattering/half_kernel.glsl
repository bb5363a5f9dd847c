// Taps of a profile for the two blurs of separable scattering: each stands for a bin of the profile. Before it is included
// there must be
//     vec3 within_line(ScatteringProfileRow profile, float x)
// the share of the light from within x mm of a straight line on both sides, for each channel: 0 to 1.
// half_kernel is 32 texels wide, one for each tap from the middle outwards, and a row high for each profile: weight for red,
// green and blue, and distance, mm; the other half is the same.
#include <scattering/by_index.glsl>

const float kReached = 0.999;  // edge response where the outermost bin ends
// How much bins are spread evenly over the square root of distance rather than over the light. With 63 taps and d of
// 8, 12 and 16 px edges are off by 0.009 and amplitudes of waves by less than 0.01; only over the light waves would
// be off by 0.03, only over distance edges by 0.016.
const float kOverDistance = 0.35;

float mean_of(vec3 value) { return (value.r + value.g + value.b) / 3.0; }

// How far along the bins x mm is: 0 in the middle, 1 at the end of the outermost.
float progress(ScatteringProfileRow profile, float x, float end) {
    vec3 direct = profile.direct;
    float light = mean_of((within_line(profile, x) - direct) / max(within_line(profile, end) - direct, 1e-6));
    return mix(light, sqrt(x / end), kOverDistance);
}

// The distance where channels' mean light, or progress, comes to a value; by bisection.
float where_light_is(ScatteringProfileRow profile, float light) {
    float low = 0.0, high = profile.reach;
    for (int i = 0; i < 32; ++i) {
        float x = 0.5 * (low + high);
        if (mean_of(within_line(profile, x)) < light) low = x;
        else high = x;
    }
    return 0.5 * (low + high);
}

float where_least_channel_is(ScatteringProfileRow profile, float light) {
    float low = 0.0, high = profile.reach;
    for (int i = 0; i < 32; ++i) {
        float x = 0.5 * (low + high);
        vec3 within = within_line(profile, x);
        if (min(within.r, min(within.g, within.b)) < light) low = x;
        else high = x;
    }
    return 0.5 * (low + high);
}

float where_progress_is(ScatteringProfileRow profile, float value, float end) {
    float low = 0.0, high = end;
    for (int i = 0; i < 32; ++i) {
        float x = 0.5 * (low + high);
        if (progress(profile, x, end) < value) low = x;
        else high = x;
    }
    return 0.5 * (low + high);
}

// The share of bin `tap`, from the middle outwards, where the bin has its median: a hard edge is wrong by half a bin
// at most.
vec4 binned(ScatteringProfileRow profile, int tap, int outermost) {
    float end = where_least_channel_is(profile, 2.0 * kReached - 1.0), bins = float(outermost) + 0.5;
    float high = tap == outermost ? end : where_progress_is(profile, (float(tap) + 0.5) / bins, end);
    vec3 within_high = tap == outermost ? vec3(1.0) : within_line(profile, high);
    if (tap == 0) return vec4(within_high, 0.0);
    float low = where_progress_is(profile, (float(tap) - 0.5) / bins, end);
    vec3 within_low = within_line(profile, low);
    float median = where_light_is(profile, 0.5 * (mean_of(within_low) + mean_of(within_line(profile, high))));
    return vec4(0.5 * (within_high - within_low), median);
}

// Whether the texel of half_kernel is a tap of `taps`, of a profile that there is; which.
bool find_tap(int taps, out int tap, out int index) {
    tap = int(gl_FragCoord.x);
    index = int(gl_FragCoord.y);
    return index < profile_count() && tap <= taps / 2;
}
