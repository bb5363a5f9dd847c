#version 450 core
#include <pass>
#include <erf.glsl>
#include <scattering/profile.glsl>

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

#include <scattering/half_kernel.glsl>

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
    int tap, index;
    out_half_kernel = vec4(0.0);
    if (!find_tap(param.samples, tap, index)) return;
#if KERNEL == KERNEL_ARTIST
    out_half_kernel = artist_tap(profile_at(index), tap, param.samples / 2);
#else
    out_half_kernel = binned(profile_at(index), tap, param.samples / 2);
#endif
}
