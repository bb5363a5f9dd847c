// Shares of light between facets. Needs the parameter geometry.
#include <scattering/facet.glsl>
#include <scattering/profile.glsl>

// Burley's R is infinite in the middle, but what a facet keeps is what lies within the mean distance of its edge: of a
// rectangle of sides 1 and a that is (asinh(a) + a asinh(1 / a)) / pi. On a plane face-on all shares sum to 1 within 5e-4 for
// d of a pixel.
vec3 own_share(ScatteringProfileRow profile, Facet here) {
    float a = max(here.spread, 1.0);
    return profile_within(profile, here.side_mm * (asinh(a) + a * asinh(1.0 / a)) / kBurleyPi);
}

// Mean of 1 / r over a facet that a slant draws out: of a segment through its middle along the slant, as long as makes a
// square drawn out to the facet's length, sqrt(spread^2 - 1); for a facet face-on 1 / r. `way` goes from here to its middle.
float mean_inverse_distance(Facet there, vec3 way, float r) {
    vec3 along = there.position - dot(there.position, there.normal) * there.normal;
    float off = dot(way, along), square = there.side_mm * there.side_mm;
    off = abs(off) * inversesqrt(max(dot(along, along), 1e-8 * dot(there.position, there.position)));
    float half_length = 0.5 * sqrt(square * max(there.spread * there.spread - 1.0, 1e-2));
    float beside = max(r * r - off * off, 0.0025 * square), a = off - half_length, b = off + half_length;
    // asinh(b / beside) - asinh(a / beside), with beside squared. Far out a + sqrt(a * a + beside) would cancel to nothing.
    float root = sqrt(a * a + beside), from_a = a < 0.0 && a * a > 1e4 * beside ? beside / (root - a) : a + root;
    return log((b + sqrt(b * b + beside)) / from_a) / (2.0 * half_length);
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
    vec3 on_disk = sqrt(max(r * r - along * along, 0.25 * there.side_mm * there.side_mm * there.spread));
    vec3 weight = facing * facing;
    return dot(weight, 1.0 / on_disk) / max(weight.x + weight.y + weight.z, 1e-12);
}
#else
float inverse_distance(Facet here, Facet there, vec3 way, float r) { return 1.0 / r; }
#endif

// Share of the light of another facet that comes to this one's middle. Of Burley's profile the mean over the pixel's square to
// second order: its Laplacian over 24 times the square is added.
vec3 share_of(ScatteringProfileRow profile, Facet here, Facet there) {
    vec3 way = there.position - here.position;
    float distance = max(length(way), 1e-6), square = there.side_mm * there.side_mm;
    float mean = mean_inverse_distance(there, way, distance), r = 1.0 / mean;
    float nearness = square * there.spread * inverse_distance(here, there, way, distance) * (mean * distance);
#if SCATTERING_PROFILE_IS_BURLEY
    vec3 per = 1.0 / profile.d;
    float area = square / 24.0;
    vec3 falls = exp(-r * per / 3.0), own = per / 3.0;
    vec3 near = falls * falls * falls * (1.0 + area * (per * (per + mean) + mean * mean));
    vec3 far = falls * (1.0 + area * (own * (own + mean) + mean * mean));
    vec3 share = nearness / (8.0 * kBurleyPi) * per * (near + far);
#else
    vec3 share = nearness / (2.0 * kBurleyPi) * scattering_profile_radial(profile, r);
#endif
    return r > profile.reach ? vec3(0.0) : share;
}
