// The twin of glsl/burley.glsl against numerical integrals and published values, and the GLSL against the
// twin.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "framework/scene/scatter_points.h"
#include "tests/backends.h"
#include "tests/glsl/shader_table.h"
#include "tests/reference/burley.h"

namespace aftershade::test {
namespace {

namespace twin = reference;
using twin::BurleyMapping;

constexpr double kPi = std::numbers::pi;
/// Widths of three channels; all that scales with d must.
constexpr double kWidths[] = {3.67, 1.37, 0.06};

/// Simpson's rule over n intervals, n even.
double integral(const std::function<double(double)>& f, double from, double to, int n = 20000) {
    const double step = (to - from) / n;
    double sum = f(from) + f(to);
    for (int i = 1; i < n; ++i) sum += (i % 2 ? 4 : 2) * f(from + i * step);
    return sum * step / 3;
}

/// Beyond 120 d there is 3e-18 of the light.
constexpr double kFar = 120;

// ---- the twin ----

TEST(BurleyTwin, SharesOutAllTheLight) {
    for (const double d : kWidths) {
        const auto density = [d](double r) { return twin::burley_radial_density(r, d); };
        EXPECT_NEAR(integral(density, 0, kFar * d, 80000), 1, 1e-12) << d;
        const auto ring = [d](double r) { return 2 * kPi * r * twin::burley_profile(r, d); };
        EXPECT_NEAR(integral(ring, 1e-9 * d, kFar * d), 1, 1e-8) << d;
    }
}

TEST(BurleyTwin, HasTheIntegralOfItsDensityAsItsDistribution) {
    for (const double d : kWidths)
        for (const double x : {0.01, 0.3, 1.0, 4.0, 16.0, 40.0}) {
            const auto density = [d](double r) { return twin::burley_radial_density(r, d); };
            EXPECT_NEAR(twin::burley_within(x * d, d), integral(density, 0, x * d), 1e-13) << x;
            EXPECT_NEAR(twin::burley_within(x * d, d) + twin::burley_beyond(x * d, d), 1, 1e-15) << x;
        }
    // Blender cuts its profile here, and names the share that is left.
    EXPECT_NEAR(twin::burley_within(16, 1), 0.99638, 1e-5);
}

TEST(BurleyTwin, InvertsItsDistributionExactly) {
    for (const double d : kWidths)
        for (int i = 0; i < 4096; ++i) {
            const double u = i / 4096.0;
            ASSERT_NEAR(twin::burley_within(twin::burley_radius(u, d), d), u, 1e-12) << u;
        }
    for (const double u : {1e-9, 1 - 1e-6, 1 - 0x1p-24})
        EXPECT_NEAR(twin::burley_within(twin::burley_radius(u, 1), 1), u, 1e-12) << u;
}

TEST(BurleyTwin, HasThePublishedQuantilesAndMoments) {
    const double quantiles[][2] = {{0.5, 1.5522},  {0.9, 6.062},   {0.95, 8.129}, {0.99, 12.953},
                                   {0.995, 15.03}, {0.997, 16.56}, {0.999, 19.86}};
    for (const auto& [u, x] : quantiles) EXPECT_NEAR(twin::burley_radius(u, 2) / 2, x, 6e-4 * x) << u;
    const auto moment = [](int power) {
        return integral([&](double r) { return std::pow(r, power) * twin::burley_radial_density(r, 1); }, 0,
                        kFar);
    };
    EXPECT_NEAR(moment(1), 2.5, 1e-9);
    EXPECT_NEAR(moment(2), 14, 1e-9);
}

TEST(BurleyTwin, IsTheProfileThatTheRendererScattersBy) {
    for (const double d : kWidths)
        for (const double u : {0.001, 0.1, 0.5, 0.9, 0.999}) {
            const double r = twin::burley_radius(u, d);
            EXPECT_NEAR(scene::burley_radius(u) * d, r, 1e-12 * r) << u;
            EXPECT_NEAR(scene::burley_density(r, d) / twin::burley_profile(r, d), 1, 1e-12) << u;
        }
}

TEST(BurleyFit, IsWithinAPercentOfTheDistributionAndShortFarOut) {
    double worst = 0, worst_at = 0, squares = 0;
    constexpr int kSteps = 100000;
    for (int i = 0; i < kSteps; ++i) {
        const double u = (i + 0.5) / kSteps;
        const double off = std::abs(twin::burley_within(twin::burley_radius_fit(u, 1), 1) - u);
        squares += off * off / kSteps;
        if (off > worst) worst = off, worst_at = u;
    }
    EXPECT_NEAR(worst, 0.0099, 1e-4);
    EXPECT_NEAR(worst_at, 0.92, 0.01);
    EXPECT_NEAR(squares, 2.9e-5, 2e-7);
    const auto off = [](double u) { return twin::burley_radius_fit(u, 1) / twin::burley_radius(u, 1) - 1; };
    for (double u = 0.01; u < 0.6; u += 0.01) EXPECT_LT(std::abs(off(u)), 0.025) << u;
    EXPECT_NEAR(off(0.9), -0.045, 5e-4);
    EXPECT_NEAR(off(0.95), -0.063, 5e-4);
    EXPECT_NEAR(off(0.99), -0.088, 5e-4);
}

TEST(BurleyFit, HasItsSlopesInverseAsItsDensity) {
    for (const double d : kWidths)
        for (const double u : {0.01, 0.3, 0.7, 0.95}) {
            const double step = 1e-6;
            const double slope =
                (twin::burley_radius_fit(u + step, d) - twin::burley_radius_fit(u - step, d)) / (2 * step);
            EXPECT_NEAR(twin::burley_fit_density(u, d) * slope, 1, 1e-8) << u;
        }
}

/// With the true density its radii's mean is 2.9 % short; with their own it is right.
TEST(BurleyFit, IsWithoutBiasWhereItsOwnDensityDivides) {
    double biased = 0, weights = 0, mean = 0;
    constexpr int kSteps = 1000000;
    for (int i = 0; i < kSteps; ++i) {
        const double u = (i + 0.5) / kSteps, r = twin::burley_radius_fit(u, 1);
        const double weight = twin::burley_radial_density(r, 1) / twin::burley_fit_density(u, 1);
        biased += r / kSteps;
        weights += weight / kSteps;
        mean += weight * r / kSteps;
    }
    EXPECT_NEAR(biased, 2.428, 1e-3);
    EXPECT_NEAR(weights, 1, 1e-5);
    EXPECT_NEAR(mean, 2.5, 1e-3);
}

TEST(BurleyWeight, MakesSamplesOfOneWidthAMeanOverAnother) {
    // The share of light within 2 units, of narrower channels, by samples of the widest.
    for (const double d : kWidths) {
        double sum = 0;
        constexpr int kSteps = 200000;
        for (int i = 0; i < kSteps; ++i) {
            const double r = twin::burley_radius((i + 0.5) / kSteps, kWidths[0]);
            if (r < 2) sum += twin::burley_weight(r, d, r, kWidths[0]) / kSteps;
        }
        EXPECT_NEAR(sum, twin::burley_within(2, d), 1e-4) << d;
    }
    EXPECT_NEAR(twin::burley_weight(5, 2, 3, 2), twin::burley_profile(5, 2) / twin::burley_profile(3, 2),
                1e-15);
}

TEST(BurleyMappings, HaveThePublishedValues) {
    const double albedo[] = {0.1, 0.5, 0.8, 1};
    const double searchlight[] = {4.151, 1.539, 1.05, 0.906};
    const double diffuse[] = {3.515, 1.715, 1.10, 1.04};
    const double dmfp[] = {3.780, 3.584, 8.380, 23.65};
    for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR(twin::burley_shape(BurleyMapping::searchlight, albedo[i]), searchlight[i], 1e-3);
        EXPECT_NEAR(twin::burley_shape(BurleyMapping::diffuse, albedo[i]), diffuse[i], 1e-3);
        EXPECT_NEAR(twin::burley_shape(BurleyMapping::dmfp, albedo[i]), dmfp[i], 6e-3);
    }
    const auto skin = twin::burley_d(BurleyMapping::dmfp, {0.91058, 0.338275, 0.2718}, {2.6748, 1, 1});
    EXPECT_NEAR(skin[0], 0.180, 5e-4);
}

TEST(BurleyLine, IsTheProfilesMarginal) {
    for (const double x : {0.05, 0.5, 2.0, 7.0}) {
        // y = sinh(t) takes the peak at small x apart.
        const auto across = [x](double t) {
            const double y = x * std::sinh(t);
            return 2 * twin::burley_profile(std::hypot(x, y), 1) * x * std::cosh(t);
        };
        EXPECT_NEAR(integral(across, 0, std::asinh(kFar / x)), twin::burley_line_spread(x, 1), 1e-9) << x;
    }
}

TEST(BurleyEdge, IsThePublishedTableAndTheLinesIntegral) {
    const double table[][2] = {{0.1, 0.56318}, {0.25, 0.62176}, {0.5, 0.68977}, {1, 0.77699},
                               {2, 0.87056},   {3, 0.91917},    {4, 0.94762},   {6, 0.97672},
                               {8, 0.98925},   {12, 0.99758},   {16, 0.99943}};
    for (const auto& [x, light] : table) {
        EXPECT_NEAR(twin::burley_edge_response(x, 1), light, 6e-6) << x;
        EXPECT_NEAR(twin::burley_edge_response(-x * 2.5, 2.5), 1 - light, 6e-6) << x;
        // x = t^2 t^2 leaves nothing of the logarithm at 0 that Simpson's rule would notice.
        const auto line = [](double t) { return twin::burley_line_spread(t * t * t * t, 1) * 4 * t * t * t; };
        EXPECT_NEAR(twin::burley_edge_response(x, 1), 0.5 + integral(line, 1e-9, std::pow(x, 0.25)), 1e-9)
            << x;
    }
    EXPECT_EQ(twin::burley_edge_response(0, 1), 0.5);
    EXPECT_NEAR(twin::burley_edge_response(500, 1), 1, 1e-14);
}

TEST(BurleyModulation, IsThePublishedTableAndTheProfilesHankelTransform) {
    const double table[][2] = {{0.1, 0.96713}, {0.25, 0.84254}, {0.5, 0.63963},
                               {1, 0.41395},   {2, 0.23510},    {5, 0.09892}};
    for (const auto& [w, left] : table) {
        EXPECT_NEAR(twin::burley_modulation(w / 3, 3), left, 6e-6) << w;
        const auto ring = [w = w](double r) {
            return twin::burley_radial_density(r, 1) * std::cyl_bessel_j(0, w * r);
        };
        EXPECT_NEAR(twin::burley_modulation(w, 1), integral(ring, 0, kFar), 1e-9) << w;
    }
}

// ---- the GLSL ----

constexpr int kCount = 4096;
const char* const kHead = R"(#include <burley.glsl>
float u_of(int i) { return (float(i) + 0.5) / 4096.0; }
float r_of(int i) { return exp2(float(i) * (15.0 / 4096.0) - 10.0); }
)";
/// Exact in a float, as in the shader.
double u_of(int i) {
    return (i + 0.5) / kCount;
}

class BurleyShader : public gpu::OnEachBackend {
protected:
    /// The largest error over max(|expected|, floor), of values by i and component.
    static double worst(const Image& got, int components, double floor,
                        const std::function<double(int, int)>& expected) {
        double most = 0;
        for (int i = 0; i < got.width(); ++i)
            for (int c = 0; c < components; ++c) {
                const double value = expected(i, c), off = std::abs(double(got.at(i, 0, c)) - value);
                most = std::max(most, std::isfinite(off) ? off / std::max(std::abs(value), floor) : INFINITY);
            }
        return most;
    }
    static Image table(const std::string& expression) {
        return shader_table(kHead, expression, kCount, "rgba32f", GetParam());
    }
};

/// exp's error grows with its argument: 3 + 2 |x| units of 2^-23 where a specification speaks of it
/// (Vulkan's, table of precision), 8e-6 at x = 32. The rest are a few roundings.
constexpr double kRelative = 1e-5;
/// Around 1 a logarithm is within 2^-21 by that table; Golubev's form takes it three times, of an argument
/// that a power has left with some 10 roundings of 2^-24: 3.3e-6 d in all; Mesa has 1.5e-6.
constexpr double kOfRadius = 5e-6;

TEST_P(BurleyShader, HasTheTwinsProfileDensityAndDistribution) {
    const Image one = table(
        "vec4(r_of(i), burley_profile(r_of(i), 1.0), burley_radial_density(r_of(i), 1.0), "
        "burley_beyond(r_of(i), 1.0))");
    const auto expected = [&](int i, int c) {
        const double r = one.at(i, 0, 0);
        return c == 0   ? r
               : c == 1 ? twin::burley_profile(r, 1)
               : c == 2 ? twin::burley_radial_density(r, 1)
                        : twin::burley_beyond(r, 1);
    };
    EXPECT_LT(worst(one, 4, 0, expected), kRelative);
    EXPECT_LT(one.at(0, 0, 0), 0.001f);
    EXPECT_GT(one.at(kCount - 1, 0, 0), 31.8f);

    const Image three = table("vec4(burley_profile(r_of(i), vec3(4.0, 2.0, 1.0)), r_of(i))");
    const Image within =
        table("vec4(burley_within(r_of(i), vec3(4.0, 2.0, 1.0)), burley_within(r_of(i), 3.0))");
    const double d[] = {4, 2, 1, 3};
    EXPECT_LT(worst(three, 3, 0, [&](int i, int c) { return twin::burley_profile(three.at(i, 0, 3), d[c]); }),
              kRelative);
    // Near 0 it is 1 minus almost 1: right to two roundings of 1 and the exponentials' error there.
    EXPECT_LT(worst(within, 4, 1, [&](int i, int c) { return twin::burley_within(three.at(i, 0, 3), d[c]); }),
              1e-6);
}

TEST_P(BurleyShader, HasTheTwinsRadii) {
    const Image radii = table(
        "vec4(burley_radius(u_of(i), 1.0), burley_radius(u_of(i), 2.5), "
        "burley_radius_fit(u_of(i), 1.0), burley_radius_fit(u_of(i), 2.5))");
    const auto expected = [](int i, int c) {
        const double d = c % 2 ? 2.5 : 1;
        return c < 2 ? twin::burley_radius(u_of(i), d) : twin::burley_radius_fit(u_of(i), d);
    };
    EXPECT_LT(worst(radii, 4, 1, expected), kOfRadius);
    const Image density =
        table("vec4(burley_fit_density(u_of(i), 1.0), burley_fit_density(u_of(i), 2.5), 0, 0)");
    EXPECT_LT(
        worst(density, 2, 0, [](int i, int c) { return twin::burley_fit_density(u_of(i), c ? 2.5 : 1); }),
        kOfRadius);
}

TEST_P(BurleyShader, HasRadiiThatAreNumbersAtBothEnds) {
    const Image ends = table(
        "vec4(burley_radius(0.0, 1.0), burley_radius(1.0 - exp2(-24.0), 1.0), "
        "burley_radius_fit(0.0, 1.0), burley_radius_fit(1.0 - exp2(-24.0), 1.0))");
    const double last = 1 - 0x1p-24;
    EXPECT_NEAR(ends.at(0, 0, 0), 0, kOfRadius);
    EXPECT_GE(ends.at(0, 0, 0), 0);
    EXPECT_NEAR(ends.at(0, 0, 1), twin::burley_radius(last, 1), 1e-4);
    EXPECT_NEAR(ends.at(0, 0, 2), 0, kOfRadius);
    EXPECT_NEAR(ends.at(0, 0, 3), twin::burley_radius_fit(last, 1), 1e-4);
}

TEST_P(BurleyShader, HasTheTwinsWeights) {
    const Image weights =
        table("vec4(burley_weight(1.25 * r_of(i), vec3(4.0, 2.0, 1.0), r_of(i), 4.0), r_of(i))");
    const auto expected = [&](int i, int c) {
        const double d[] = {4, 2, 1}, radius = weights.at(i, 0, 3);
        return twin::burley_weight(1.25 * radius, d[c], radius, 4);
    };
    EXPECT_LT(worst(weights, 3, 0, expected), 2 * kRelative);
    const Image middle = table("vec4(burley_weight(0.0, vec3(4.0, 2.0, 1.0), 0.0, 4.0), 0)");
    for (int c = 0; c < 3; ++c) EXPECT_EQ(middle.at(0, 0, c), float(1 << c));
}

TEST_P(BurleyShader, MapsMeanFreePathsAsTheTwin) {
    const BurleyMapping mappings[] = {BurleyMapping::searchlight, BurleyMapping::diffuse,
                                      BurleyMapping::dmfp};
    const char* names[] = {"kBurleySearchlight", "kBurleyDiffuse", "kBurleyDmfp"};
    for (int k = 0; k < 3; ++k) {
        const Image d = table(fmt::format(
            "vec4(burley_d({}, vec3(u_of(i), 1.0 - u_of(i), 0.5), vec3(1.0, 2.0, 3.0)), 0)", names[k]));
        const auto expected = [&](int i, int c) {
            return twin::burley_d(mappings[k], {u_of(i), 1 - u_of(i), 0.5}, {1, 2, 3})[std::size_t(c)];
        };
        EXPECT_LT(worst(d, 3, 0, expected), 1e-6) << names[k];
    }
}

ON_EACH_BACKEND(BurleyShader);

}  // namespace
}  // namespace aftershade::test
