#include "framework/scattering/scattering_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/reference/burley.h"
#include "tests/scattering/scattering_profiles.h"

namespace aftershade {
namespace {

using test::Jensen;
using test::profile_of;
using test::shipped_skin;
using Type = ScatteringProfile::Type;

constexpr double kPi = std::numbers::pi;

/// The integral of f(r) dr over all r > 0, lengths in units of `scale`: the trapezium rule over ln r, exact
/// to rounding for what is analytic and falls off at both ends.
double integral(const std::function<double(double)>& f, double scale) {
    constexpr double kStep = 1.0 / 64;
    double sum = 0;
    for (double u = -34; u < 7.5; u += kStep) {
        const double r = scale * std::exp(u);
        sum += f(r) * r;
    }
    return sum * kStep;
}

/// From 0 to `end`, by Simpson's rule; `f` is smooth there.
double integral_to(double end, const std::function<double(double)>& f) {
    constexpr int kIntervals = 4000;
    const double h = end / kIntervals;
    double sum = f(1e-12 * end) + f(end);
    for (int i = 1; i < kIntervals; ++i) sum += (i % 2 ? 4 : 2) * f(i * h);
    return sum * h / 3;
}

std::vector<ScatteringProfile> one_of_each() {
    return {profile_of(R"({"type": "burley", "d_mm": [0.7, 0.2, 3]})"), shipped_skin(),
            profile_of(R"({"type": "dipole", "absorption_per_mm": [0.0021, 0.17, 1.45],
                           "reduced_scattering_per_mm": [2.19, 0.88, 0.03], "ior": 1.5})"),
            profile_of(R"({"type": "artist"})")};
}

const std::string& name_of(const ScatteringProfile& profile) {
    return scattering_type_names()[std::size_t(profile.type)];
}

double rms_mm(const ScatteringProfile& profile, int c) {
    return std::sqrt(profile.mean_square_mm2(c));
}

TEST(ScatteringProfile, OfEveryTypeSpreadsAllTheLightThatIsNotDirect) {
    for (const ScatteringProfile& profile : one_of_each())
        for (int c = 0; c < 3; ++c) {
            const auto radial = [&](double r) { return 2 * kPi * r * profile.density(c, r); };
            EXPECT_NEAR(integral(radial, rms_mm(profile, c)), 1 - profile.direct[std::size_t(c)], 1e-12)
                << name_of(profile) << " " << c;
        }
}

TEST(ScatteringProfile, OfEveryTypeHasTheIntegralOfItsDensityWithinARadius) {
    for (const ScatteringProfile& profile : one_of_each())
        for (int c = 0; c < 3; ++c)
            for (const double share : {0.01, 0.2, 1.0, 3.0}) {
                const double end = share * rms_mm(profile, c);
                const auto radial = [&](double r) { return 2 * kPi * r * profile.density(c, r); };
                EXPECT_NEAR(profile.within(c, end), profile.direct[std::size_t(c)] + integral_to(end, radial),
                            1e-9)
                    << name_of(profile) << " " << c << " " << end;
            }
}

TEST(ScatteringProfile, OfEveryTypeHasTheMeanSquareOfItsDensity) {
    for (const ScatteringProfile& profile : one_of_each())
        for (int c = 0; c < 3; ++c) {
            const double rms = rms_mm(profile, c);
            const auto moment = [&](double r) { return 2 * kPi * r * r * r * profile.density(c, r); };
            const double scattered = 1 - profile.direct[std::size_t(c)];
            EXPECT_NEAR(integral(moment, rms) / scattered, rms * rms, 1e-11 * rms * rms)
                << name_of(profile) << " " << c;
            EXPECT_NEAR(profile.fitted_d_mm()[std::size_t(c)], rms / std::sqrt(14.0), 1e-12 * rms);
        }
}

TEST(ScatteringProfile, OfBurleyIsTheTwinsToRounding) {
    const ScatteringProfile profile = one_of_each()[0];
    for (int c = 0; c < 3; ++c) {
        const double d = profile.d_mm[std::size_t(c)];
        for (const double x : {1e-6, 0.1, 1.0, 7.0, 30.0}) {
            const double density = reference::burley_profile(x * d, d);
            EXPECT_NEAR(profile.density(c, x * d), density, 1e-14 * density);
            EXPECT_NEAR(profile.within(c, x * d), reference::burley_within(x * d, d), 1e-15);
        }
        EXPECT_EQ(profile.fitted_d_mm()[std::size_t(c)], d);
    }
}

// s(A) for A = 0.1, 0.5, 0.8 and 1, computed by hand from the three polynomials.
TEST(ScatteringProfile, OfBurleyHasTheThreeMappingsFromAlbedoAndPath) {
    const std::array<double, 4> albedos = {0.1, 0.5, 0.8, 1};
    const std::array<std::array<double, 4>, 3> shapes = {
        {{4.151, 1.539, 1.05, 0.906}, {3.515, 1.715, 1.10, 1.04}, {3.780, 3.584, 8.380, 23.651}}};
    for (std::size_t m = 0; m < 3; ++m)
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_NEAR(2 / burley_d_mm(BurleyMapping(m), albedos[i], 2), shapes[m][i], 6e-4)
                << m << " " << albedos[i];
            EXPECT_NEAR(burley_d_mm(BurleyMapping(m), albedos[i], 2),
                        2 / reference::burley_shape(reference::BurleyMapping(m), albedos[i]), 1e-15);
        }
}

TEST(ScatteringProfile, HasTheRadiusWithinWhichAShareComesOut) {
    for (const ScatteringProfile& profile : one_of_each())
        for (int c = 0; c < 3; ++c)
            for (const double share : {0.75, 0.9, 0.99})
                EXPECT_NEAR(profile.within(c, profile.radius_mm(c, share)), share, 1e-8)
                    << name_of(profile) << " " << c;
    EXPECT_NEAR(one_of_each()[0].radius_mm(0, 0.5), 0.7 * 1.5522, 1e-4);
    EXPECT_EQ(one_of_each()[3].radius_mm(0, 0.5), 0) << "0.52 is direct";
}

TEST(ScatteringProfile, SpreadsALineAsItsClosedForms) {
    const auto profiles = one_of_each();
    for (std::size_t c = 0; c < 3; ++c)
        for (const double share : {0.001, 0.1, 1.0, 4.0}) {
            const double d = profiles[0].d_mm[c], x = share * rms_mm(profiles[0], int(c));
            const double line = reference::burley_line_spread(x, d);
            EXPECT_NEAR(profiles[0].line_spread(int(c), x), line, 1e-10 * line);
            const double y = share * rms_mm(profiles[1], int(c));
            double sum = 0;
            for (const ScatteringGaussian& g : profiles[1].gaussians)
                sum += g.weight[c] * std::exp(-y * y / (2 * g.variance_mm2[c])) /
                       std::sqrt(2 * kPi * g.variance_mm2[c]);
            EXPECT_NEAR(profiles[1].line_spread(int(c), y), sum, 1e-10 * sum);
        }
}

TEST(ScatteringProfile, OfSixGaussiansIsThePublishedSkin) {
    const ScatteringProfile skin = shipped_skin();
    ASSERT_EQ(skin.gaussians.size(), 6u);
    const Rgb rms = {1.663, 0.369, 0.223}, d = {0.4445, 0.0987, 0.0595};
    for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (const ScatteringGaussian& gaussian : skin.gaussians) sum += gaussian.weight[c];
        EXPECT_NEAR(sum, 1, 1e-15);
        EXPECT_NEAR(rms_mm(skin, int(c)), rms[c], 5e-4);
        EXPECT_NEAR(skin.fitted_d_mm()[c], d[c], 5e-5);
    }
    EXPECT_EQ(skin.as_gaussians(), skin.gaussians);
}

TEST(ScatteringProfile, OfADipoleIsJensensOverItsTotal) {
    const ScatteringProfile profile = one_of_each()[2];
    for (std::size_t c = 0; c < 3; ++c) {
        const Jensen jensen{profile.absorption[c], profile.scattering[c], profile.ior};
        const double rms = rms_mm(profile, int(c));
        EXPECT_NEAR(integral([&](double r) { return 2 * kPi * r * jensen.profile(r); }, rms), jensen.total(),
                    1e-12);
        for (const double r : {1e-3, 0.1, 1.0, 5.0, 20.0}) {
            const double density = jensen.profile(r) / jensen.total();
            EXPECT_NEAR(profile.density(int(c), r), density, 1e-12 * density) << c << " at " << r;
        }
    }
}

/// As SeparableSSS.cpp of Jimenez' published code has it: amplitudes of red for all channels, radii over
/// 0.001 + falloff.
double jimenez_profile(double r, double falloff) {
    const auto gaussian = [&](double variance) {
        const double rr = r / (0.001 + falloff);
        return std::exp(-(rr * rr) / (2 * variance)) / (2 * kPi * variance);
    };
    return 0.100 * gaussian(0.0484) + 0.118 * gaussian(0.187) + 0.113 * gaussian(0.567) +
           0.358 * gaussian(1.99) + 0.078 * gaussian(7.41);
}

TEST(ScatteringProfile, OfAnArtistIsThePublishedOneOverItsIntegral) {
    const Rgb falloff = {1, 0.37, 0.3}, strength = {0.48, 0.41, 0.28};
    const double width = 2.5;
    const ScatteringProfile profile = profile_of(R"({"type": "artist", "width_mm": 2.5})");
    for (std::size_t c = 0; c < 3; ++c) {
        const auto radial = [&](double r) { return 2 * kPi * r * jimenez_profile(r, falloff[c]); };
        const double total = integral(radial, falloff[c]);
        for (const double r : {0.0, 0.1, 1.0, 4.0}) {
            const double density = strength[c] * jimenez_profile(r, falloff[c]) / total / (width * width);
            EXPECT_NEAR(profile.density(int(c), width * r), density, 1e-12 * density);
        }
        EXPECT_NEAR(profile.direct[c], 1 - strength[c], 1e-15);
        EXPECT_NEAR(profile.within(int(c), 0), 1 - strength[c], 1e-15);
        EXPECT_NEAR(profile.falloff_mm[c], width * (0.001 + falloff[c]), 1e-15);
        EXPECT_EQ(profile.fitted_falloff_mm()[c], profile.falloff_mm[c]);
    }
}

TEST(ScatteringProfile, OfAnotherTypeHasTheArtistsFalloffOfItsMeanSquare) {
    const ScatteringProfile artist = one_of_each()[3];
    for (const ScatteringProfile& profile : one_of_each())
        for (std::size_t c = 0; c < 3; ++c) {
            const double ratio = profile.fitted_falloff_mm()[c] / artist.falloff_mm[c];
            EXPECT_NEAR(rms_mm(profile, int(c)), ratio * rms_mm(artist, int(c)),
                        1e-12 * rms_mm(profile, int(c)));
        }
}

TEST(ScatteringProfile, ReachesAsFarAsItsWidestChannelHasTheShareThatItSays) {
    for (const ScatteringProfile& profile : one_of_each()) {
        double most = 0;
        for (int c = 0; c < 3; ++c) most = std::max(most, 1 - profile.within(c, profile.reach_mm()));
        EXPECT_NEAR(most, ScatteringProfile::kBeyondReach, 1e-9) << name_of(profile);
    }
    EXPECT_NEAR(profile_of(R"({"type": "burley", "d_mm": 2})").reach_mm(),
                reference::burley_radius(1 - ScatteringProfile::kBeyondReach, 2), 1e-6);
}

/// The mean distance by which light must move for one CDF to become the other, over the rms radius.
double distance(const ScatteringProfile& profile, const std::vector<ScatteringGaussian>& fit, std::size_t c) {
    const double rms = rms_mm(profile, int(c));
    const auto difference = [&](double r) {
        double within = 0;
        for (const ScatteringGaussian& gaussian : fit)
            within -= gaussian.weight[c] * std::expm1(-r * r / (2 * gaussian.variance_mm2[c]));
        return std::abs(within - profile.within(int(c), r));
    };
    return integral(difference, rms) / rms;
}

TEST(ScatteringProfile, IsFittedByGaussiansThatKeepAllLightAndItsMeanSquare) {
    for (const ScatteringProfile& profile : one_of_each()) {
        const auto fit = profile.as_gaussians();
        for (std::size_t c = 0; c < 3; ++c) {
            double sum = 0, mean_square = 0;
            for (const ScatteringGaussian& gaussian : fit) {
                sum += gaussian.weight[c];
                mean_square += 2 * gaussian.weight[c] * gaussian.variance_mm2[c];
            }
            const double scattered = 1 - profile.direct[c],
                         expected = scattered * profile.mean_square_mm2(int(c));
            EXPECT_NEAR(sum, scattered, 1e-12) << name_of(profile);
            EXPECT_NEAR(mean_square, expected, 1e-10 * expected) << name_of(profile);
            if (profile.direct[c] == 0) {
                EXPECT_LT(distance(profile, fit, c), 0.006) << name_of(profile) << " " << c;
                RecordProperty(name_of(profile) + std::to_string(c),
                               std::to_string(distance(profile, fit, c)));
            }
        }
    }
}

TEST(ScatteringProfile, IsFittedByTheSameGaussiansAtEveryScale) {
    const auto small = profile_of(R"({"type": "burley", "d_mm": 0.01})").as_gaussians();
    const auto large = profile_of(R"({"type": "burley", "d_mm": 1000})").as_gaussians();
    ASSERT_EQ(small.size(), std::size_t(ScatteringProfile::kFittedGaussians));
    for (std::size_t k = 0; k < small.size(); ++k) {
        EXPECT_NEAR(small[k].weight[0], large[k].weight[0], 1e-6);
        EXPECT_NEAR(small[k].variance_mm2[0] * 1e10, large[k].variance_mm2[0],
                    1e-5 * large[k].variance_mm2[0]);
    }
}

/// The radius of sample i, from which linear interpolation goes.
double sample_radius(const ScatteringProfile& profile, int i) {
    const double t = double(i) / (kScatteringSamples - 1);
    return profile.reach_mm() * t * t;
}

TEST(ScatteringCurves, AreTheTwinsOfBurley) {
    const ScatteringProfile profile = one_of_each()[0];
    const ScatteringCurves curves = scattering_curves(profile);
    ASSERT_EQ(curves.radial.size(), std::size_t(kScatteringSamples));
    ASSERT_EQ(curves.within.size(), std::size_t(kScatteringSamples));
    ASSERT_EQ(curves.line.size(), std::size_t(kScatteringSamples));
    for (std::size_t c = 0; c < 3; ++c) {
        const double d = profile.d_mm[c];
        EXPECT_NEAR(curves.radial[0][c], 1 / (2 * d), 1e-6 / d) << "the limit at r = 0";
        EXPECT_NEAR(curves.line[0][c], 0.5, 1e-15);
        for (int i = 1; i < kScatteringSamples; i += 31) {
            const double r = sample_radius(profile, i);
            const auto at = std::size_t(i);
            EXPECT_NEAR(curves.radial[at][c], reference::burley_radial_density(r, d), 1e-12 / d) << i;
            EXPECT_NEAR(curves.within[at][c], reference::burley_within(r, d), 1e-14) << i;
            EXPECT_NEAR(curves.line[at][c], reference::burley_edge_response(r, d), 1e-13)
                << i << " " << r / d;
        }
    }
}

TEST(ScatteringCurves, OfGaussiansAreErrorFunctionsAcrossAnEdge) {
    for (const ScatteringProfile& profile : {one_of_each()[1], one_of_each()[3]}) {
        const ScatteringCurves curves = scattering_curves(profile);
        for (std::size_t c = 0; c < 3; ++c)
            for (int i = 0; i < kScatteringSamples; i += 31) {
                const double x = sample_radius(profile, i);
                double line = profile.direct[c];
                for (const ScatteringGaussian& gaussian : profile.gaussians)
                    line += gaussian.weight[c] *
                            (0.5 + 0.5 * std::erf(x / std::sqrt(2 * gaussian.variance_mm2[c])));
                EXPECT_NEAR(curves.line[std::size_t(i)][c], line, 1e-13) << name_of(profile) << " " << i;
            }
    }
}

}  // namespace
}  // namespace aftershade
