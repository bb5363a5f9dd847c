#include "framework/scattering/scattering_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aftershade {

namespace {

constexpr double kPi = std::numbers::pi;

/// A dipole of one channel, as the paper has it; lengths in mm.
struct Dipole {
    double real_mm, virtual_mm;  // depths z_r and z_v of the two sources
    double transport;            // sigma_tr, 1/mm
    double total;                // 2 pi times the integral of r R_d(r), over half alpha'

    Dipole(double absorption, double scattering, double ior) {
        const double extinction = absorption + scattering;
        const double fresnel = -1.440 / (ior * ior) + 0.710 / ior + 0.668 + 0.0636 * ior;
        const double boundary = (1 + fresnel) / (1 - fresnel);
        real_mm = 1 / extinction;
        virtual_mm = real_mm * (1 + 4 * boundary / 3);
        transport = std::sqrt(3 * absorption * extinction);
        total = std::exp(-transport * real_mm) + std::exp(-transport * virtual_mm);
    }

    double source(double depth_mm, double radius_mm) const {
        const double way = std::hypot(radius_mm, depth_mm);
        return depth_mm * (transport * way + 1) * std::exp(-transport * way) / (way * way * way);
    }
    /// What remains beyond a radius of one source: -exp(-s d) / d is the integral of (s d + 1) exp(-s d) /
    /// d^2.
    double source_beyond(double depth_mm, double radius_mm) const {
        const double way = std::hypot(radius_mm, depth_mm);
        return depth_mm * std::exp(-transport * way) / way;
    }
    double density(double radius_mm) const {
        return (source(real_mm, radius_mm) + source(virtual_mm, radius_mm)) / (2 * kPi * total);
    }
    double beyond(double radius_mm) const {
        return (source_beyond(real_mm, radius_mm) + source_beyond(virtual_mm, radius_mm)) / total;
    }
};

Dipole dipole_of(const ScatteringProfile& profile, int channel) {
    const auto c = std::size_t(channel);
    return {profile.absorption[c], profile.scattering[c], profile.ior};
}

/// 1 - within(), to full relative precision.
double beyond(const ScatteringProfile& profile, int channel, double radius_mm) {
    const auto c = std::size_t(channel);
    if (profile.type == ScatteringProfile::Type::burley) {
        const double x = radius_mm / profile.d_mm[c];
        return 0.25 * std::exp(-x) + 0.75 * std::exp(-x / 3);
    }
    if (profile.type == ScatteringProfile::Type::dipole) return dipole_of(profile, channel).beyond(radius_mm);
    double sum = 0;
    for (const ScatteringGaussian& gaussian : profile.gaussians)
        sum += gaussian.weight[c] * std::exp(-radius_mm * radius_mm / (2 * gaussian.variance_mm2[c]));
    return sum;
}

/// The light at x >= 0 into the lit side of a straight edge. Of what goes in the direction at an angle a to
/// the normal of the edge, half of what goes farther than x / cos a comes from the dark side; cos a = 1 /
/// cosh t makes an integrand for which the trapezium rule is exact to rounding (Trefethen and Weideman 2014).
double edge_response(const ScatteringProfile& profile, int channel, double x_mm) {
    constexpr double kStep = 1.0 / 8, kEnd = 40;
    double dark = beyond(profile, channel, x_mm) / 2;
    for (int i = 1; i * kStep < kEnd; ++i) {
        const double cosh = std::cosh(i * kStep);
        const double term = beyond(profile, channel, x_mm * cosh) / cosh;
        dark += term;
        if (term < 1e-17) break;
    }
    return 1 - dark * kStep / kPi;
}

/// The radius beyond which `share` of a channel's light lies, by bisection.
double radius_beyond(const ScatteringProfile& profile, int channel, double share) {
    double low = 0, high = 1e-6;
    while (beyond(profile, channel, high) > share) high *= 2;
    while (high - low > 1e-9 * high) {
        const double middle = 0.5 * (low + high);
        (beyond(profile, channel, middle) > share ? low : high) = middle;
    }
    return high;
}

/// One channel's Gaussians of least Kullback-Leibler distance to radii of equal shares, as (variance,
/// weight).
std::vector<std::array<double, 2>> fit_gaussians(const std::vector<double>& square_radii_mm2) {
    constexpr int kRounds = 200;
    const std::size_t count = ScatteringProfile::kFittedGaussians, radii = square_radii_mm2.size();
    std::vector<std::array<double, 2>> fit(count);
    // To begin with, the half of a mean square in each of `count` parts, inner to outer.
    for (std::size_t k = 0; k < count; ++k) {
        double sum = 0;
        const std::size_t first = k * radii / count, last = (k + 1) * radii / count;
        for (std::size_t i = first; i < last; ++i) sum += square_radii_mm2[i];
        fit[k] = {sum / double(2 * (last - first)), 1.0 / double(count)};
    }
    std::vector<double> share(count);
    for (int round = 0; round < kRounds; ++round) {
        std::vector<double> weights(count, 0.0), squares(count, 0.0);
        for (const double square : square_radii_mm2) {
            double sum = 0;
            for (std::size_t k = 0; k < count; ++k)
                sum += share[k] = fit[k][1] / fit[k][0] * std::exp(-square / (2 * fit[k][0]));
            for (std::size_t k = 0; k < count; ++k) {
                weights[k] += share[k] / sum;
                squares[k] += share[k] / sum * square;
            }
        }
        for (std::size_t k = 0; k < count; ++k)
            if (weights[k] > 0) fit[k] = {squares[k] / (2 * weights[k]), weights[k] / double(radii)};
    }
    std::sort(fit.begin(), fit.end());
    return fit;
}

}  // namespace

double ScatteringProfile::density(int channel, double radius_mm) const {
    const auto c = std::size_t(channel);
    if (type == Type::burley) {
        const double x = radius_mm / d_mm[c];
        return (std::exp(-x) + std::exp(-x / 3)) / (8 * kPi * d_mm[c] * radius_mm);
    }
    if (type == Type::dipole) return dipole_of(*this, channel).density(radius_mm);
    double sum = 0;
    for (const ScatteringGaussian& gaussian : gaussians) {
        const double variance = gaussian.variance_mm2[c];
        sum += gaussian.weight[c] * std::exp(-radius_mm * radius_mm / (2 * variance)) / (2 * kPi * variance);
    }
    return sum;
}

double ScatteringProfile::within(int channel, double radius_mm) const {
    return 1 - beyond(*this, channel, radius_mm);
}

double ScatteringProfile::radius_mm(int channel, double share) const {
    return 1 - share >= beyond(*this, channel, 0) ? 0 : radius_beyond(*this, channel, 1 - share);
}

double ScatteringProfile::line_spread(int channel, double x_mm) const {
    // Along the line y = x sinh t, so that r = x cosh t: the trapezium rule as in edge_response().
    constexpr double kStep = 1.0 / 16, kEnd = 40;
    double sum = x_mm * density(channel, x_mm) / 2;
    for (int i = 1; i * kStep < kEnd; ++i) {
        const double r = x_mm * std::cosh(i * kStep);
        sum += r * density(channel, r);
    }
    return 2 * kStep * sum;
}

double ScatteringProfile::mean_square_mm2(int channel) const {
    const auto c = std::size_t(channel);
    if (type == Type::burley) return 14 * d_mm[c] * d_mm[c];
    double sum = 0;
    if (type != Type::dipole) {
        for (const ScatteringGaussian& gaussian : gaussians)
            sum += 2 * gaussian.weight[c] * gaussian.variance_mm2[c];
        return sum / (1 - direct[c]);
    }
    // The integral of 2 r beyond(r), by parts; from way to way: r dr = way dway, so that each source gives
    // 2 z times the integral of exp(-s way) from z on, 2 z exp(-s z) / s.
    const Dipole dipole = dipole_of(*this, channel);
    for (const double depth_mm : {dipole.real_mm, dipole.virtual_mm})
        sum += 2 * depth_mm * std::exp(-dipole.transport * depth_mm) / dipole.transport;
    return sum / dipole.total;
}

Rgb ScatteringProfile::fitted_d_mm() const {
    if (type == Type::burley) return d_mm;
    Rgb d{};
    for (int c = 0; c < 3; ++c) d[std::size_t(c)] = std::sqrt(mean_square_mm2(c) / 14);
    return d;
}

Rgb ScatteringProfile::fitted_falloff_mm() const {
    if (type == Type::artist) return falloff_mm;
    double unit_mm2 = 0;
    for (const auto& [variance, weight] : artist_gaussians()) unit_mm2 += 2 * weight * variance;
    Rgb falloff{};
    for (int c = 0; c < 3; ++c) falloff[std::size_t(c)] = std::sqrt(mean_square_mm2(c) / unit_mm2);
    return falloff;
}

double ScatteringProfile::reach_mm() const {
    double reach = 0;
    for (int c = 0; c < 3; ++c) reach = std::max(reach, radius_beyond(*this, c, kBeyondReach));
    return reach;
}

std::vector<ScatteringGaussian> ScatteringProfile::as_gaussians() const {
    if (type == Type::gaussians || type == Type::artist) return gaussians;
    constexpr int kRadii = 256;
    std::vector<ScatteringGaussian> result(kFittedGaussians);
    for (int c = 0; c < 3; ++c) {
        std::vector<double> squares;
        for (int i = 0; i < kRadii; ++i) {
            const double radius_mm = radius_beyond(*this, c, 1 - (i + 0.5) / kRadii);
            squares.push_back(radius_mm * radius_mm);
        }
        // Equal shares cut the tail's last one short; the mean square is known, and the fit keeps it.
        double mean = 0;
        for (const double square : squares) mean += square / kRadii;
        squares.back() += kRadii * (mean_square_mm2(c) - mean);
        const auto fit = fit_gaussians(squares);
        for (std::size_t k = 0; k < fit.size(); ++k) {
            result[k].variance_mm2[std::size_t(c)] = fit[k][0];
            result[k].weight[std::size_t(c)] = fit[k][1];
        }
    }
    return result;
}

ScatteringCurves scattering_curves(const ScatteringProfile& profile) {
    ScatteringCurves curves;
    const double reach = profile.reach_mm();
    const auto radius = [&](double i) {
        return reach * (i / (kScatteringSamples - 1)) * (i / (kScatteringSamples - 1));
    };
    // Below it 2 pi r density(r) has come to its limit, to float's precision.
    const double least_mm = 1e-9 * reach;
    for (int i = 0; i < kScatteringSamples; ++i) {
        Rgb radial{}, within{}, line{};
        for (int c = 0; c < 3; ++c) {
            const double r = std::max(radius(i), least_mm);
            radial[std::size_t(c)] = 2 * kPi * r * profile.density(c, r);
            within[std::size_t(c)] = profile.within(c, radius(i));
            line[std::size_t(c)] = edge_response(profile, c, radius(i));
        }
        curves.radial.push_back(radial);
        curves.within.push_back(within);
        curves.line.push_back(line);
    }
    return curves;
}

const std::vector<std::array<double, 2>>& artist_gaussians() {
    constexpr double kSum = 0.100 + 0.118 + 0.113 + 0.358 + 0.078;
    static const std::vector<std::array<double, 2>> gaussians = {{0.0484, 0.100 / kSum},
                                                                 {0.187, 0.118 / kSum},
                                                                 {0.567, 0.113 / kSum},
                                                                 {1.99, 0.358 / kSum},
                                                                 {7.41, 0.078 / kSum}};
    return gaussians;
}

double burley_d_mm(BurleyMapping mapping, double albedo, double mean_free_path_mm) {
    const double off = albedo - (mapping == BurleyMapping::dmfp ? 0.33 : 0.8);
    if (mapping == BurleyMapping::searchlight)
        return mean_free_path_mm / (1.85 - albedo + 7 * std::abs(off * off * off));
    if (mapping == BurleyMapping::diffuse) return mean_free_path_mm / (1.9 - albedo + 3.5 * off * off);
    return mean_free_path_mm / (3.5 + 100 * off * off * off * off);
}

}  // namespace aftershade
