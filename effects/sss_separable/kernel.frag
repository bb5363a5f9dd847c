#version 450 core
#include <pass>
#include <erf.glsl>
#include <scattering/by_index.glsl>
#include <scattering/profile.glsl>

const float kReached = 0.999;  // edge response where the outermost bin ends
// How much bins are spread evenly over the square root of distance rather than over the light. With 63 taps and d of
// 8, 12 and 16 px edges are off by 0.009 and amplitudes of waves by less than 0.01; only over the light waves would
// be off by 0.03, only over distance edges by 0.016.
const float kOverDistance = 0.35;

// Share of the light from within x mm of a straight line on both sides, for each channel: 0 to 1.
vec3 within_line(ScatteringProfileRow profile, float x) {
#if KERNEL == KERNEL_PREINTEGRATED
    return 2.0 * scattering_profile_line(profile, x) - 1.0;
#else
    vec3 sum = profile.direct;
    for (int k = 0; k < SCATTERING_PROFILE_GAUSSIANS; ++k) {
        vec3 far = x * inversesqrt(2.0 * max(scattering_profile_variance(profile, k), 1e-20));
        sum += scattering_profile_weight(profile, k) * erf_of(far);
    }
    return sum;
#endif
}

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

// Weight of a place on the line as the published code has it: amplitudes over the plane, but as a function of one
// dimension; the five wider Gaussians of skin with the weights of red, for all channels over their falloff.
vec3 artist_amplitude(vec3 radius) {
    const vec2 kGaussians[5] = vec2[5](vec2(0.100, 0.0484), vec2(0.118, 0.187), vec2(0.113, 0.567), vec2(0.358, 1.99),
                                       vec2(0.078, 7.41));
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 5; ++k)
        sum += kGaussians[k].x / (2.0 * kBurleyPi * kGaussians[k].y) * exp(-radius * radius / (2.0 * kGaussians[k].y));
    return sum;
}

// Distance of a tap in the unit of the published code.
float artist_offset(int tap, int outermost) {
    float far = float(tap) / float(outermost);
    return (outermost >= 10 ? 3.0 : 2.0) * far * far;
}

vec4 artist_tap(ScatteringProfileRow profile, int tap, int outermost) {
    // Falloffs there are 1e-3 more than what is set; of the widest channel 1 is.
    float unit = max(profile.falloff.r, max(profile.falloff.g, profile.falloff.b)) / 1.001;
    vec3 sum = vec3(0.0), own = vec3(0.0);
    for (int i = 0; i <= outermost; ++i) {
        float inner = artist_offset(abs(i - 1), outermost) * (i == 0 ? -1.0 : 1.0), at = artist_offset(i, outermost);
        float outer = i == outermost ? at : artist_offset(i + 1, outermost);
        vec3 weight = 0.5 * (outer - inner) * artist_amplitude(unit * at / profile.falloff);
        sum += i == 0 ? weight : 2.0 * weight;
        if (i == tap) own = weight;
    }
    vec3 strength = 1.0 - profile.direct;
    return vec4(strength * own / sum + (tap == 0 ? profile.direct : vec3(0.0)), unit * artist_offset(tap, outermost));
}

void main() {
    int tap = int(gl_FragCoord.x), index = int(gl_FragCoord.y), outermost = param.samples / 2;
    out_half_kernel = vec4(0.0);
    if (index >= profile_count() || tap > outermost) return;
    ScatteringProfileRow profile = profile_at(index);
#if KERNEL == KERNEL_ARTIST
    out_half_kernel = artist_tap(profile, tap, outermost);
#else
    out_half_kernel = binned(profile, tap, outermost);
#endif
}
