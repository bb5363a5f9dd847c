#include "framework/scene/rings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aftershade::scene {

double burley_density(double radius_m, double d_m) {
    return (std::exp(-radius_m / d_m) + std::exp(-radius_m / (3 * d_m))) /
           (8 * std::numbers::pi * d_m * radius_m);
}

double burley_radius(double u) {
    const double rest = 1 - u;
    const double g = 1 + 4 * rest * (2 * rest + std::sqrt(1 + 4 * rest * rest));
    const double root = std::cbrt(g);
    return 3 * std::log((1 + 1 / root + root) / (4 * rest));
}

std::vector<QuadratureNode> gauss_legendre(int count) {
    std::vector<QuadratureNode> nodes;
    const auto order = unsigned(count);
    for (int i = 0; i < count; ++i) {
        // Newton's method from Tricomi's estimate (1950).
        double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5));
        double slope = 1;
        for (int step = 0; step < 20; ++step) {
            const double value = std::legendre(order, x);
            slope = count * (x * value - std::legendre(order - 1, x)) / (x * x - 1);
            x -= value / slope;
            if (std::abs(value / slope) < 1e-15) break;
        }
        nodes.push_back({(1 - x) / 2, 1 / ((1 - x * x) * slope * slope)});
    }
    return nodes;
}

std::vector<Ring> make_rings(const Scattering& scattering, int count) {
    std::vector<double> widths_m = {scattering.d_m.x, scattering.d_m.y, scattering.d_m.z};
    std::sort(widths_m.begin(), widths_m.end());
    widths_m.erase(std::unique(widths_m.begin(), widths_m.end()), widths_m.end());
    const int each = std::max(count / int(widths_m.size()), 1);
    const std::vector<QuadratureNode> nodes = gauss_legendre(each);
    std::vector<Ring> rings;
    for (const double d_m : widths_m)
        for (const QuadratureNode& node : nodes) {
            const double radius_m = d_m * burley_radius(node.at);
            double density = 0;
            for (const double other_m : widths_m) density += burley_density(radius_m, other_m);
            rings.push_back({radius_m, node.weight / density});
        }
    return rings;
}

}  // namespace aftershade::scene
