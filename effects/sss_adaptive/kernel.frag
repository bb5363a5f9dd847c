#version 450 core
#include <pass>
#include <scattering/profile.glsl>

// The profile as a straight edge of light shows it.
vec3 within_line(ScatteringProfileRow profile, float x) { return 2.0 * scattering_profile_line(profile, x) - 1.0; }

#include <scattering/half_kernel.glsl>

void main() {
    int tap, index;
    out_half_kernel = find_tap(param.blur_samples, tap, index) ? binned(profile_at(index), tap, param.blur_samples / 2) : vec4(0.0);
}
