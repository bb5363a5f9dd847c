// Where the scattering integral is taken: radii of a profile's own distribution.
#pragma once

#include <vector>

#include "framework/scene/scene.h"

namespace aftershade::scene {

/// Of Burley's profile with `d_m`, over the albedo: 1 / m^2 (Christensen and Burley 2015, equation 3).
double burley_density(double radius_m, double d_m);

/// The r / d within which `u` (0 to 1) of the light comes back: the exact inverse of
/// 1 - exp(-x) / 4 - 3/4 exp(-x / 3) (Golubev, "Sampling Burley's Normalized Diffusion Profiles", 2019).
double burley_radius(double u);

/// Points and weights of the integral from 0 to 1 by Gauss and Legendre; `count` from 1.
struct QuadratureNode {
    double at = 0;
    double weight = 0;
};
std::vector<QuadratureNode> gauss_legendre(int count);

struct Ring {
    double radius_m = 0;
    double area_m2 = 0;  ///< that its points stand for together
};

/// About `count` rings. The radii are the Gauss-Legendre points of each channel's distribution, brought
/// together by the balance heuristic (Veach and Guibas 1995), so that narrow and wide channels are both met.
std::vector<Ring> make_rings(const Scattering& scattering, int count);

}  // namespace aftershade::scene
