// Shares of light between facets. Needs the parameter geometry.
#include <scattering/facet.glsl>
#include <scattering/profile.glsl>

// Mean distance of a unit square's edge from its middle: 2 / pi * ln(1 + sqrt(2)). Burley's R is infinite in the middle, but
// what a square keeps is what lies within about this distance: on a plane all shares sum to 1 within 5e-4 for d of a pixel.
const float kSquareRadius = 0.5611;

vec3 own_share(ScatteringProfileRow profile, Facet here) {
    return profile_within(profile, kSquareRadius * sqrt(here.area_mm2));
}

// Two unit vectors at right angles to a unit vector and each other. Duff and others 2017, Building an Orthonormal Basis,
// Revisited.
void make_axes(vec3 normal, out vec3 tangent, out vec3 bitangent) {
    float side = normal.z < 0.0 ? -1.0 : 1.0;
    float a = -1.0 / (side + normal.z), b = normal.x * normal.y * a;
    tangent = vec3(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x);
    bitangent = vec3(b, side + normal.y * normal.y * a, -normal.y);
}

#if GEOMETRY == GEOMETRY_AXES
// 1 / r of the profile as path tracers have it that place samples on disks along three axes, half of them along the normal,
// weigh each by the density of distances alone and join the axes by the power heuristic (King, Kulla, Conty, Fajardo 2013,
// BSSRDF Importance Sampling; Cycles' Burley). On a plane that is the distance.
float inverse_distance(Facet here, Facet there, vec3 way, float r) {
    vec3 tangent, bitangent;
    make_axes(here.normal, tangent, bitangent);
    vec3 facing = vec3(0.5, 0.25, 0.25) *
        abs(vec3(dot(here.normal, there.normal), dot(tangent, there.normal), dot(bitangent, there.normal)));
    vec3 along = vec3(dot(here.normal, way), dot(tangent, way), dot(bitangent, way));
    vec3 on_disk = sqrt(max(r * r - along * along, 0.25 * there.area_mm2));
    vec3 weight = facing * facing;
    return dot(weight, 1.0 / on_disk) / max(weight.x + weight.y + weight.z, 1e-12);
}
#else
float inverse_distance(Facet here, Facet there, vec3 way, float r) { return 1.0 / r; }
#endif

// Share of the light of another facet that comes to this one's middle. Of Burley's profile the mean over the facet to second
// order: its Laplacian over 24 times the area is added.
vec3 share_of(ScatteringProfileRow profile, Facet here, Facet there) {
    vec3 way = there.position - here.position;
    float r = max(length(way), 1e-6);
    float nearness = there.area_mm2 * inverse_distance(here, there, way, r);
#if SCATTERING_PROFILE_IS_BURLEY
    vec3 per = 1.0 / profile.d;
    float area = there.area_mm2 / 24.0;
    vec3 near = exp(-r * per) * (1.0 + area * (per * per + per / r + 1.0 / (r * r)));
    vec3 far = exp(-r * per / 3.0) * (1.0 + area * (per * per / 9.0 + per / (3.0 * r) + 1.0 / (r * r)));
    vec3 share = nearness / (8.0 * kBurleyPi) * per * (near + far);
#else
    vec3 share = nearness / (2.0 * kBurleyPi) * scattering_profile_radial(profile, r);
#endif
    return r > profile.reach ? vec3(0.0) : share;
}
