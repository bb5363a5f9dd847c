// Where the scattering integral is taken: points by a profile's own distribution.
#pragma once

#include <vector>

#include "framework/scene/scene.h"

namespace aftershade::scene {

/// Density of Burley's profile with `d_m`, over the albedo: 1 / m^2 (Christensen and Burley 2015, equation
/// 3).
double burley_density(double radius_m, double d_m);

/// The r / d within which `u` (0 to 1) of the light comes back: the exact inverse of
/// 1 - exp(-x) / 4 - 3/4 exp(-x / 3) (Golubev, "Sampling Burley's Normalized Diffusion Profiles", 2019).
double burley_radius(double u);

/// Share per m^2 at a distance above 0, over the albedo and without what is direct.
double scattering_density(const Scattering& scattering, int channel, double radius_m);

/// A point around another, in the plane of its surface.
struct ScatterPoint {
    double radius_m = 0;
    double angle_rad = 0;
    double area_m2 = 0;  ///< that it stands for
};

/// About `count` points, for each d of the profile's channels on a spiral of its own: the radii divide
/// the channel's distribution, its tail most finely, the angles advance by the golden ratio of a turn (Vogel
/// 1979), so that no edge meets many points at once. The balance heuristic (Veach and Guibas 1995) brings the
/// spirals together.
std::vector<ScatterPoint> make_scatter_points(const Scattering& scattering, int count);

}  // namespace aftershade::scene
