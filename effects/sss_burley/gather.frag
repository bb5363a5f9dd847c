#version 450 core
#include <pass>
#include <scattering/facet.glsl>
#include <scattering/profile.glsl>
#include <scattering/result.glsl>
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

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Facet here = read_facet(p);
    out_irradiance = texelFetch(irradiance, p, 0);
    if (here.key == 0u) return;
    ViewLines lines = view_lines();
    ScatteringProfileRow profile = profile_of(here);
    vec3 at = view_position(lines, gl_FragCoord.xy, here.depth_m);
    float per_mm = pixels_per_mm(lines, here.depth_m);
    float inner = 0.5 / per_mm;
    vec3 own = profile_within(profile, inner);
    vec3 beyond_inner = max(burley_beyond(inner, profile.d), 1e-30);
    uvec2 full = uvec2(floor((gl_FragCoord.xy + vec2(frame.origin)) / frame.scale));
    uvec2 start = r2_start(full, pcg3d(uvec3(frame.number, frame.step_seed, param.seed)).x);
    vec3 sum = own * here.light, share = own;
    for (int i = 0; i < param.samples; ++i) {
        vec2 u = r2_point(start, uint(i));
        Sample drawn = draw_sample(profile.d, beyond_inner, u.y);
        float angle_rad = 2.0 * kBurleyPi * u.x;
        vec2 place = gl_FragCoord.xy + drawn.radius * per_mm * vec2(cos(angle_rad), sin(angle_rad));
        bool inside = all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, vec2(frame.size)));
        ivec2 q = clamp(ivec2(floor(place)), ivec2(0), frame.size - 1);
        Facet there = read_facet(q);
        if (!inside || there.key != here.key) continue;
        float r = distance(at, facet_position(lines, there, q, place));
        float scale = there.depth_m / here.depth_m;
        float area = scale * scale * spread_of(there.slope, view_line(lines, place));
        vec3 weight = profile_density(profile, max(r, 1e-3 * inner)) * (area / (drawn.density * float(param.samples)));
        sum += weight * there.light;
        share += weight;
    }
    out_irradiance = scattered_result(p, filled(sum, share));
}
