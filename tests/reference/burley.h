// The double-precision twin of glsl/burley.glsl, and what it makes of simple light in closed form.
//
// Burley's normalized diffusion: Christensen and Burley 2015, Approximate Reflectance Profiles for Efficient
// Subsurface Scattering, Pixar 15-04. Lengths (r, d, x) share one unit; d > 0. All functions are pure and may
// be called from any thread.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

namespace aftershade::reference {

/// R(r) over the albedo, share of the light per area at distance r > 0: 1 / length^2. The density, per area,
/// of samples whose radii are burley_radius().
inline double burley_profile(double r, double d) {
    return (std::exp(-r / d) + std::exp(-r / (3 * d))) / (8 * std::numbers::pi * d * r);
}

/// 2 pi r R(r), share per radius at r >= 0: 1 / length.
inline double burley_radial_density(double r, double d) {
    return (std::exp(-r / d) + std::exp(-r / (3 * d))) / (4 * d);
}

/// Share that comes out farther away than r >= 0: 1 - CDF(r), to full relative precision.
inline double burley_beyond(double r, double d) {
    return 0.25 * std::exp(-r / d) + 0.75 * std::exp(-r / (3 * d));
}

/// Share that comes out within r >= 0: the CDF, to full relative precision.
inline double burley_within(double r, double d) {
    return -0.25 * std::expm1(-r / d) - 0.75 * std::expm1(-r / (3 * d));
}

/// The radius within which the share u comes out, 0 <= u < 1: the exact inverse of burley_within() as Golubev
/// 2019, "Sampling Burley's Normalized Diffusion Profiles", writes it.
inline double burley_radius(double u, double d) {
    const double rest = 1 - u;
    const double root = std::cbrt(1 + 4 * rest * (2 * rest + std::sqrt(1 + 4 * rest * rest)));
    return 3 * d * std::log((1 + root + 1 / root) / (4 * rest));
}

/// The c of the approximation: that which makes the mean squared error of its CDF least.
inline constexpr double kBurleyFit = 2.5715;

/// An approximation to burley_radius() with one logarithm, 0 <= u < 1 (Xie and others 2020, Real-Time
/// Subsurface Scattering with Single Pass Variance-Guided Adaptive Importance Sampling).
inline double burley_radius_fit(double u, double d) {
    return d * ((2 - kBurleyFit) * u - 2) * std::log1p(-u);
}

/// Density of burley_radius_fit() per radius: 1 / (dr/du), 1 / length.
inline double burley_fit_density(double u, double d) {
    const double slope = (2 - kBurleyFit) * std::log1p(-u) - ((2 - kBurleyFit) * u - 2) / (1 - u);
    return 1 / (d * slope);
}

/// Weight of a sample that was placed in the plane at `radius` > 0 for a profile of width `sampled_d`, and
/// lies at distance r >= radius in space: R(r; d) over the density of its place.
inline double burley_weight(double r, double d, double radius, double sampled_d) {
    return burley_profile(r, d) / burley_profile(radius, sampled_d);
}

/// What the mean free path is of which burley_d() makes d.
enum class BurleyMapping {
    searchlight,  ///< light enters at right angles; mean free path
    diffuse,      ///< light enters in all directions; mean free path
    dmfp,         ///< light enters at right angles; diffuse mean free path within the volume
};

/// s(A) of Christensen and Burley: d is the path over it. A: the surface's albedo, 0 to 1.
inline double burley_shape(BurleyMapping mapping, double albedo) {
    switch (mapping) {
        case BurleyMapping::searchlight: return 1.85 - albedo + 7 * std::pow(std::abs(albedo - 0.8), 3);
        case BurleyMapping::diffuse: return 1.9 - albedo + 3.5 * std::pow(albedo - 0.8, 2);
        case BurleyMapping::dmfp: break;
    }
    return 3.5 + 100 * std::pow(albedo - 0.33, 4);
}

/// d of each channel, in the path's unit.
inline std::array<double, 3> burley_d(BurleyMapping mapping, const std::array<double, 3>& albedo,
                                      const std::array<double, 3>& path) {
    std::array<double, 3> d;
    for (std::size_t c = 0; c < 3; ++c) d[c] = path[c] / burley_shape(mapping, albedo[c]);
    return d;
}

/// Light of a line in the plane at distance x != 0 from it, 1 / length: (K0(x/d) + K0(x/(3d))) / (4 pi d).
inline double burley_line_spread(double x, double d) {
    const double far = std::abs(x) / d;
    return (std::cyl_bessel_k(0, far) + std::cyl_bessel_k(0, far / 3)) / (4 * std::numbers::pi * d);
}

/// Integral of K0 from 0 to x >= 0: of (1 - exp(-x cosh t)) / cosh t over t > 0. The trapezium rule is exact
/// to rounding here, as the integrand is analytic and falls like exp(-t) (Trefethen and Weideman 2014).
inline double integral_of_k0(double x) {
    constexpr double kStep = 1.0 / 16, kEnd = 44;
    double sum = -std::expm1(-x) / 2;
    for (int i = 1; i * kStep < kEnd; ++i) {
        const double cosh = std::cosh(i * kStep);
        sum -= std::expm1(-x * cosh) / cosh;
    }
    return sum * kStep;
}

/// Light at x from the edge of a lit half plane, x > 0 within the light: S(x/d), 0 to 1.
inline double burley_edge_response(double x, double d) {
    const double far = std::abs(x) / d;
    const double half = (integral_of_k0(far) + 3 * integral_of_k0(far / 3)) / (4 * std::numbers::pi);
    return 0.5 + std::copysign(half, x);
}

/// What is left of the amplitude of light cos(w x), w in radians per length: M(w), 0 to 1.
inline double burley_modulation(double w, double d) {
    return 0.25 / std::hypot(1, w * d) + 0.75 / std::hypot(1, 3 * w * d);
}

}  // namespace aftershade::reference
