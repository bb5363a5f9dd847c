// The light of samples of the profile. Before it is included there must be
//     vec3 light_of_sample(Facet there, vec2 place, float area_px)
// the light that a sample at a place in px brings, which stands for so much of the picture; and the parameters sampling,
// geometry and normalize.
#include <scattering/gathered.glsl>
#include <scattering/sampling.glsl>
#include <scattering/share.glsl>
#include <scattering/start.glsl>
#include <sequence.glsl>

// Each sample falls on the plane and counts for the pixel that it falls on, as far as that pixel's facet gives its light here:
// the mean over all samples is the sum over all facets. `count` is at least 1: a loop that tests before its first turn takes one more
// on llvmpipe.
Gathered gathered(ViewLines lines, ivec2 p, Facet here, uvec2 start, int count) {
    ScatteringProfileRow profile = scattering_profile(here.key - 1u);
    float per_mm = pixels_per_mm(lines, here.depth_m), inner = 0.5 / per_mm;
    vec3 beyond_inner = max(burley_beyond(inner, profile.d), 1e-30);
    vec3 share = own_share(profile, here), sum = share * here.light, whole = share;
    int i = 0;
    do {
        vec2 u = r2_point(start, uint(i));
        Sample drawn = draw_sample(profile.d, beyond_inner, u.y);
        float angle_rad = 2.0 * kBurleyPi * u.x;
        vec2 place = gl_FragCoord.xy + drawn.radius * per_mm * vec2(cos(angle_rad), sin(angle_rad));
        bool inside = all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, vec2(frame.size)));
        ivec2 q_free = ivec2(floor(place)), q = clamp(q_free, ivec2(0), frame.size - 1);
        Facet there = read_facet(lines, q);
        float area_px = per_mm * per_mm / (drawn.density * float(count));
        vec3 weight = share_of(profile, here, there) * area_px;
#if NORMALIZE == NORMALIZE_MISSING
        if (q_free != p) whole += share_of(profile, here, facet_on_plane(lines, here, q_free)) * area_px;
#endif
        if (!inside || there.key != here.key || q == p) continue;
        sum += weight * light_of_sample(there, place, area_px);
        share += weight;
    } while (++i < count);
#if NORMALIZE != NORMALIZE_MISSING
    whole = vec3(1.0);
#endif
    return Gathered(sum, share, whole);
}
