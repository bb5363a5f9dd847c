// The profile of an object. Distances in mm.
#include <burley.glsl>

// Share that comes out within r, for each channel.
vec3 profile_within(ScatteringProfileRow profile, float r) {
#if SCATTERING_PROFILE_IS_BURLEY
    return burley_within(r, profile.d);
#else
    return scattering_profile_within(profile, r);
#endif
}
