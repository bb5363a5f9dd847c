#version 450 core
#include <pass>
#include <scattering/result.glsl>
#include <scattering/share.glsl>
#include <sequence.glsl>

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

// Each sample falls on the plane and counts for the pixel that it falls on, as far as that pixel's facet gives its light here:
// the mean over all samples is the sum over all facets, sss_exact's, to the bit.
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    ViewLines lines = view_lines();
    Facet here = read_facet(lines, p);
    out_irradiance = texelFetch(irradiance, p, 0);
    if (here.key == 0u) return;
    ScatteringProfileRow profile = scattering_profile(here.key - 1u);
    float per_mm = pixels_per_mm(lines, here.depth_m), inner = 0.5 / per_mm;
    vec3 beyond_inner = max(burley_beyond(inner, profile.d), 1e-30);
    uvec2 full = uvec2(floor((gl_FragCoord.xy + vec2(frame.origin)) / frame.scale));
    uvec2 start = r2_start(full, pcg3d(uvec3(frame.number, frame.step_seed, param.seed)).x);
    vec3 share = own_share(profile, here), sum = share * here.light, whole = share;
    for (int i = 0; i < param.samples; ++i) {
        vec2 u = r2_point(start, uint(i));
        Sample drawn = draw_sample(profile.d, beyond_inner, u.y);
        float angle_rad = 2.0 * kBurleyPi * u.x;
        vec2 place = gl_FragCoord.xy + drawn.radius * per_mm * vec2(cos(angle_rad), sin(angle_rad));
        bool inside = all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, vec2(frame.size)));
        ivec2 q_free = ivec2(floor(place)), q = clamp(q_free, ivec2(0), frame.size - 1);
        Facet there = read_facet(lines, q);
        float scale = per_mm * per_mm / (drawn.density * float(param.samples));
        vec3 weight = share_of(profile, here, there) * scale;
#if NORMALIZE == NORMALIZE_MISSING
        if (q_free != p) whole += share_of(profile, here, facet_on_plane(lines, here, q_free)) * scale;
#endif
        if (!inside || there.key != here.key || q == p) continue;
        sum += weight * there.light;
        share += weight;
    }
#if NORMALIZE == NORMALIZE_MISSING
    // The same samples on a plane would have found the whole profile, but for their noise.
    sum /= whole;
    share /= whole;
#endif
    out_irradiance = scattered_result(p, filled(sum, share));
}
