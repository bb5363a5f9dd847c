// The profile of a pixel's object. Distances in mm.
#include <burley.glsl>

ScatteringProfileRow profile_of(Facet facet) { return scattering_profile(facet.key - 1u); }

// Share of the light per mm^2 at a distance r > 0, for each channel; without the share that comes out where it went in.
vec3 profile_density(ScatteringProfileRow profile, float r) {
#if SCATTERING_PROFILE_IS_BURLEY
    return burley_profile(r, profile.d);
#else
    return scattering_profile_radial(profile, r) / (2.0 * kBurleyPi * r);
#endif
}

// Share that comes out within r, for each channel.
vec3 profile_within(ScatteringProfileRow profile, float r) {
#if SCATTERING_PROFILE_IS_BURLEY
    return burley_within(r, profile.d);
#else
    return scattering_profile_within(profile, r);
#endif
}
