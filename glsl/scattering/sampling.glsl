// Where samples of the profile fall. Needs the parameter sampling.
#include <burley.glsl>

// A place in the plane through the pixel's middle that faces the camera: how far off, and the density of such places
// per mm^2. Within `inner` mm there are none.
struct Sample {
    float radius;
    float density;
};

const float kBelowOne = 0.99999994;  // 1 - 2^-24, the most that burley_radius() takes

Sample draw_sample(vec3 d, vec3 beyond_inner, float u) {
#if SAMPLING == SAMPLING_CHANNELS
    float channel = min(floor(3.0 * u), 2.0);
    float own_d = channel < 0.5 ? d.r : channel < 1.5 ? d.g : d.b;
    float own_beyond = channel < 0.5 ? beyond_inner.r : channel < 1.5 ? beyond_inner.g : beyond_inner.b;
    float radius = burley_radius(min(1.0 - own_beyond * (1.0 - (3.0 * u - channel)), kBelowOne), own_d);
    vec3 density = burley_profile(radius, d) / beyond_inner;
    return Sample(radius, (density.r + density.g + density.b) / 3.0);
#else
    float widest = max(d.r, max(d.g, d.b)), beyond = max(beyond_inner.r, max(beyond_inner.g, beyond_inner.b));
    float share = min(1.0 - beyond * (1.0 - u), kBelowOne);
#if SAMPLING == SAMPLING_WIDEST
    float radius = burley_radius(share, widest);
    return Sample(radius, burley_profile(radius, widest) / beyond);
#else
    float radius = burley_radius_fit(share, widest);
#if SAMPLING == SAMPLING_WIDEST_FIT
    return Sample(radius, burley_profile(radius, widest) / beyond);
#else
    return Sample(radius, burley_fit_density(share, widest) / (2.0 * kBurleyPi * radius * beyond));
#endif
#endif
#endif
}
