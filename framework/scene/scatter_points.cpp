#include "framework/scene/scatter_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aftershade::scene {

double burley_density(double radius_m, double d_m) {
    return (std::exp(-radius_m / d_m) + std::exp(-radius_m / (3 * d_m))) /
           (8 * std::numbers::pi * d_m * radius_m);
}

double scattering_density(const Scattering& scattering, int channel, double radius_m) {
    if (scattering.profile.type == ScatteringProfile::Type::burley)
        return burley_density(radius_m, scattering.d_m[channel]);
    return 1e6 * scattering.profile.density(channel, 1e3 * radius_m);
}

double burley_radius(double u) {
    const double rest = 1 - u;
    const double g = 1 + 4 * rest * (2 * rest + std::sqrt(1 + 4 * rest * rest));
    const double root = std::cbrt(g);
    return 3 * std::log((1 + 1 / root + root) / (4 * rest));
}

namespace {

/// Points an area has for each of a spiral's: u = 1 - (1 - v)^2 of the light lies within the radius of point
/// v, so that the far tail, where the light is least, is finely divided too.
double point_density(double radius_m, double d_m) {
    const double x = radius_m / d_m;
    const double outside = std::exp(-x) / 4 + 0.75 * std::exp(-x / 3);
    return burley_density(radius_m, d_m) / (2 * std::sqrt(outside));
}

}  // namespace

std::vector<ScatterPoint> make_scatter_points(const Scattering& scattering, int count) {
    std::vector<double> widths_m = {scattering.d_m.x, scattering.d_m.y, scattering.d_m.z};
    std::sort(widths_m.begin(), widths_m.end());
    widths_m.erase(std::unique(widths_m.begin(), widths_m.end()), widths_m.end());
    const int each = std::max(count / int(widths_m.size()), 1);
    const double golden_turns = (std::sqrt(5.0) - 1) / 2;
    std::vector<ScatterPoint> points;
    for (const double d_m : widths_m)
        for (int i = 0; i < each; ++i) {
            const double rest = 1 - (i + 0.5) / each;
            const double radius_m = d_m * burley_radius(1 - rest * rest);
            double density = 0;
            for (const double other_m : widths_m) density += point_density(radius_m, other_m);
            const double turns = std::fmod(i * golden_turns, 1.0);
            points.push_back({radius_m, 2 * std::numbers::pi * turns, 1 / (each * density)});
        }
    return points;
}

}  // namespace aftershade::scene
