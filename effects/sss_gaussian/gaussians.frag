#version 450 core
#include <pass>
#include <scattering/by_index.glsl>

// One channel's Gaussians that have weight, from narrow to wide: number `rank` among them, as (variance, weight);
// (0, 0) where there are fewer.
vec2 ranked(ScatteringProfileRow profile, int channel, int rank) {
    vec2 found = vec2(0.0);
    for (int k = 0; k < SCATTERING_PROFILE_GAUSSIANS; ++k) {
        float variance = scattering_profile_variance(profile, k)[channel];
        float weight = scattering_profile_weight(profile, k)[channel];
        int narrower = 0;
        for (int i = 0; i < SCATTERING_PROFILE_GAUSSIANS; ++i) {
            float other = scattering_profile_variance(profile, i)[channel];
            bool counts = scattering_profile_weight(profile, i)[channel] > 0.0;
            if (counts && (other < variance || (other == variance && i < k))) ++narrower;
        }
        if (weight > 0.0 && narrower == rank) found = vec2(variance, weight);
    }
    return found;
}

void main() {
    int rank = int(gl_FragCoord.x) % 8, index = int(gl_FragCoord.y);
    bool weights = gl_FragCoord.x > 8.0;
    out_gaussians = vec4(0.0);
    if (index >= profile_count()) return;
    ScatteringProfileRow profile = profile_at(index);
    vec3 weight = vec3(0.0), variance = vec3(0.0);
    float before = 1e30;
    for (int channel = 0; channel < 3; ++channel)
        for (int k = 0; k <= rank; ++k) {
            vec2 here = ranked(profile, channel, k);
            if (here.y > 0.0 && k == rank) {
                weight[channel] = here.y;
                before = min(before, sqrt(variance[channel]));
            }
            if (here.y > 0.0) variance[channel] = here.x;
        }
    out_gaussians = weights ? vec4(weight, 0.0) : vec4(variance, before);
}
