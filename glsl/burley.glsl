// Burley's normalized diffusion: how light that enters a surface comes out around the place, for each channel.
// Christensen and Burley 2015, Approximate Reflectance Profiles for Efficient Subsurface Scattering, Pixar 15-04.
//
// Lengths r and d share one unit, whichever the caller has; r > 0, d > 0. R(r) is over the albedo: its integral over the
// plane is 1. tests/reference/burley.h says the same in double precision.

const float kBurleyPi = 3.14159265358979;

// The one exponential of R(r), exp(-r / (3 d)); the other, exp(-r / d), is its cube.
float burley_far(float r, float d) { return exp(-r / (3.0 * d)); }
vec3 burley_far(float r, vec3 d) { return exp(-r / (3.0 * d)); }

float burley_sum(float r, float d) {
    float far = burley_far(r, d);
    return far * far * far + far;
}
vec3 burley_sum(float r, vec3 d) {
    vec3 far = burley_far(r, d);
    return far * far * far + far;
}

// R(r): share of the light per area at distance r, and so the density, per area, of samples whose radii are
// burley_radius(). Infinite at r = 0.
float burley_profile(float r, float d) { return burley_sum(r, d) / (8.0 * kBurleyPi * d * r); }
vec3 burley_profile(float r, vec3 d) { return burley_sum(r, d) / (8.0 * kBurleyPi * d * r); }

// 2 pi r R(r): share per radius, density of burley_radius().
float burley_radial_density(float r, float d) { return burley_sum(r, d) / (4.0 * d); }

// Share that comes out farther away than r, 1 - CDF(r), to full relative precision.
float burley_beyond(float r, float d) {
    float far = burley_far(r, d);
    return (0.25 * far * far + 0.75) * far;
}
vec3 burley_beyond(float r, vec3 d) {
    vec3 far = burley_far(r, d);
    return (0.25 * far * far + 0.75) * far;
}

// Share that comes out within r: the CDF.
float burley_within(float r, float d) { return 1.0 - burley_beyond(r, d); }
vec3 burley_within(float r, vec3 d) { return 1.0 - burley_beyond(r, d); }

// The radius within which the share u comes out, 0 <= u <= 1 - 2^-24: the exact inverse of burley_within(). Golubev 2019,
// Sampling Burley's Normalized Diffusion Profiles; his cube root of G = 1 + 4 v (2 v + sqrt(1 + 4 v^2)) with v = 1 - u is
// taken of its square root's square.
float burley_radius(float u, float d) {
    float twice = 2.0 * (1.0 - u);
    float root = pow(twice + sqrt(1.0 + twice * twice), 2.0 / 3.0);
    return d * max(3.0 * log((1.0 + root + 1.0 / root) / (2.0 * twice)), 0.0);
}

// An approximation to burley_radius() with one logarithm (Xie and others 2020, Real-Time Subsurface Scattering with Single
// Pass Variance-Guided Adaptive Importance Sampling). Within 1 % of u it is right, but far radii come out too short: by
// 4.5 % at u = 0.9, 9 % at 0.99.
const float kBurleyFit = 2.5715;
float burley_radius_fit(float u, float d) {
    return d * ((2.0 - kBurleyFit) * u - 2.0) * log(1.0 - u);
}

// Density of burley_radius_fit() per radius. Divide by it, not by burley_radial_density(), for a mean without bias.
float burley_fit_density(float u, float d) {
    float slope = (2.0 - kBurleyFit) * log(1.0 - u) - ((2.0 - kBurleyFit) * u - 2.0) / (1.0 - u);
    return 1.0 / (d * slope);
}

// R(r) over burley_profile(radius, sampled_d): the weight of a sample that was placed in the plane at `radius` for a
// profile of width sampled_d, and lies at distance r in space, where r >= radius. 1 for a sample of the plane, r = radius,
// and d = sampled_d. radius 0 is allowed.
vec3 burley_weight(float r, vec3 d, float radius, float sampled_d) {
    float nearness = r > 0.0 ? radius / r : 1.0;
    return nearness * sampled_d / d * burley_sum(r, d) / burley_sum(radius, sampled_d);
}

// d from the mean free path and the albedo A of the surface, channel by channel: d = path / s(A). What the path is, and
// with it s, is the mapping (Christensen and Burley 2015):
// searchlight: light enters at right angles, path is the mean free path;
// diffuse: light enters in all directions, path is the mean free path;
// dmfp: light enters at right angles, path is the diffuse mean free path within the volume.
const int kBurleySearchlight = 0, kBurleyDiffuse = 1, kBurleyDmfp = 2;

vec3 burley_d(int mapping, vec3 albedo, vec3 path) {
    vec3 off = albedo - (mapping == kBurleyDmfp ? 0.33 : 0.8), square = off * off;
    if (mapping == kBurleySearchlight) return path / (1.85 - albedo + 7.0 * abs(off) * square);
    if (mapping == kBurleyDiffuse) return path / (1.9 - albedo + 3.5 * square);
    return path / (3.5 + 100.0 * square * square);
}
