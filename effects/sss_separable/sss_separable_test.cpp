// Two blurs for one profile: against closed forms on planes, the published tables, and sss_exact on a head.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/backends.h"
#include "tests/look_runner.h"
#include "tests/reference/burley.h"
#include "tests/scattering_checks.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test::sss_separable {
namespace {

constexpr double kPixel_mm = kFacingPlanePixel_mm;

std::string burley(double d_px) {
    const std::string d = std::to_string(d_px * kPixel_mm);
    return R"({ "type": "burley", "d_mm": [)" + d + ", " + d + ", " + d + "] }";
}

/// `more`: further parameters, each behind a comma.
std::string look(const std::string& profile, const std::string& more = "") {
    return scattering_step("sss_separable", profile + more);
}

Image scatter(const std::string& profile, const std::string& more, const Capture& capture) {
    return scattered(look(profile, more), capture);
}

/// The most that a channel of a plane with its right or lower half in light is off, across the picture's
/// middle.
double edge_error(const std::string& profile, const std::string& more, bool along_x,
                  const std::function<double(double)>& response, int channel = 0) {
    const int size = 512;
    const Image image =
        scatter(profile, more,
                along_x ? facing_plane(size, 8, [](double x, double) { return x > 0 ? 1.0 : 0.0; })
                        : facing_plane(8, size, [](double, double y) { return y > 0 ? 1.0 : 0.0; }));
    double most = 0;
    for (int i = size / 4; i < size * 3 / 4; ++i) {
        const double got = along_x ? image.at(i, 4, channel) : image.at(4, i, channel);
        most = std::max(most, std::abs(got - response(i + 0.5 - size / 2)));
    }
    return most;
}

double burley_edge_error(double d_px, const std::string& more, bool along_x) {
    return edge_error(burley(d_px), more, along_x,
                      [&](double x) { return reference::burley_edge_response(x, d_px); });
}

/// d'Eon and Luebke's skin, for red: variance, mm^2, and weight.
constexpr double kSkinRed[][2] = {{0.0064, 0.233}, {0.0484, 0.100}, {0.187, 0.118},
                                  {0.567, 0.113},  {1.99, 0.358},   {7.41, 0.078}};

/// With or without the narrowest, whose light then stays where it is.
double skin_edge_response(double x_mm, bool narrowest) {
    double sum = 0;
    for (const auto& [variance, weight] : kSkinRed)
        sum += weight * 0.5 *
               (1 + std::erf(x_mm / (narrowest || variance > 0.01 ? std::sqrt(2 * variance) : 1e-9)));
    return sum;
}

std::string world_unit(double pixels_per_mm) {
    return R"(, "world_unit": )" + std::to_string(1000 / (kPixel_mm * pixels_per_mm));
}

const char* const kArtist =
    R"({ "type": "artist", "falloff": [1, 0.37, 0.3], "strength": [0.48, 0.41, 0.28] })";

TEST(SssSeparable, HasThePublishedTablesOfTheArtistKernel) {
    // Jimenez and Gutierrez 2012, SeparableSSS.h: red, green, blue, offset; from the middle outwards.
    using Table = std::vector<std::array<double, 4>>;
    const Table tables[] = {{{0.560479, 0.669086, 0.784728, 0},
                             {0.0771802, 0.113491, 0.0793803, 0.08},
                             {0.0821904, 0.0358608, 0.0209261, 0.32},
                             {0.03639, 0.0130999, 0.00643685, 0.72},
                             {0.0192831, 0.00282018, 0.00084214, 1.28},
                             {0.00471691, 0.000184771, 5.07566e-5, 2}},
                            {{0.536343, 0.624624, 0.748867, 0},
                             {0.0324462, 0.0656718, 0.0532821, 0.03125},
                             {0.0582416, 0.0659959, 0.0411329, 0.125},
                             {0.0571056, 0.0287432, 0.0172844, 0.28125},
                             {0.0347317, 0.0151085, 0.00871983, 0.5},
                             {0.0216301, 0.00794618, 0.00376991, 0.78125},
                             {0.0144609, 0.00317269, 0.00106399, 1.125},
                             {0.0100386, 0.000914679, 0.000275702, 1.53125},
                             {0.00317394, 0.000134823, 3.77269e-5, 2}},
                            {{0.530605, 0.613514, 0.739601, 0},
                             {0.0211412, 0.0459286, 0.0378196, 0.0208333},
                             {0.0402784, 0.0657244, 0.04631, 0.0833333},
                             {0.0493588, 0.0367726, 0.0219485, 0.1875},
                             {0.0410172, 0.0199899, 0.0118481, 0.333333},
                             {0.0263642, 0.0119715, 0.00684598, 0.520833},
                             {0.017924, 0.00711691, 0.00347194, 0.75},
                             {0.0128496, 0.00356329, 0.00132016, 1.02083},
                             {0.0094389, 0.00139119, 0.000416598, 1.33333},
                             {0.00700976, 0.00049366, 0.000151938, 1.6875},
                             {0.00500364, 0.00020094, 5.28848e-5, 2.08333},
                             {0.00333804, 7.85443e-5, 1.2945e-5, 2.52083},
                             {0.000973794, 1.11862e-5, 9.43437e-7, 3}}};
    for (const Table& table : tables) {
        const std::string samples = std::to_string(2 * table.size() - 1);
        LookRunner runner(look(kArtist, R"(, "kernel": "artist", "samples": )" + samples),
                          gpu::test_backend(), {"sss_separable.half_kernel"});
        const Image kernel = runner.run(facing_plane(8, 8, [](double, double) { return 1.0; }))
                                 .taps.at("sss_separable.half_kernel");
        for (int i = 0; i < int(table.size()); ++i)
            for (int c = 0; c < 4; ++c) {
                const double published = table[std::size_t(i)][std::size_t(c)];
                // Six digits, and single precision's share of exponents that are large.
                EXPECT_NEAR(kernel.at(i, 0, c), published, 6e-7 + 4e-6 * published)
                    << samples << " taps, " << i << ", " << c;
            }
        EXPECT_EQ(kernel.at(int(table.size()), 0, 0), 0);
    }
}

TEST(SssSeparable, SpreadsAStraightEdgeOfLightAsItsProfileDoes) {
    for (const double d : {8.0, 12.0, 16.0})
        for (const bool along_x : {true, false}) {
            const double many = burley_edge_error(d, R"(, "samples": 63)", along_x),
                         few = burley_edge_error(d, "", along_x);
            RecordProperty("edge_d" + std::to_string(int(d)) + (along_x ? "_x" : "_y"),
                           std::to_string(many) + " " + std::to_string(few));
            EXPECT_LT(many, 0.01) << d << " px, " << along_x;
            EXPECT_LT(few, 0.03) << d << " px, " << along_x;
        }
}

TEST(SssSeparable, SpreadsAnEdgeBySumsOfErrorFunctionsWithGaussians) {
    std::string red;
    for (const auto& [variance, weight] : kSkinRed)
        red += (red.empty() ? "" : ", ") + std::string(R"({ "variance_mm2": )") + std::to_string(variance) +
               R"(, "weight": )" + std::to_string(weight) + " }";
    red = R"({ "type": "gaussians", "gaussians": [ )" + red + " ] }";
    for (const double pixels_per_mm : {6.0, 10.0}) {
        const auto response = [&](double x) { return skin_edge_response(x / pixels_per_mm, true); };
        const std::string more = R"(, "kernel": "gaussian_fit", "samples": 63)" + world_unit(pixels_per_mm);
        for (const bool along_x : {true, false}) {
            EXPECT_LT(edge_error(red, more, along_x, response), 0.01) << pixels_per_mm << " " << along_x;
            // Its other channels are narrower, and the taps are for all.
            EXPECT_LT(edge_error(R"("skin")", more, along_x, response), 0.015)
                << pixels_per_mm << " " << along_x;
        }
    }
}

/// The published kernel is no marginal of its profile: how far off it is.
TEST(SssSeparable, IsOffByATenthWithTheArtistKernel) {
    const std::string red =
        R"({ "type": "artist", "falloff": [0.999, 0.999, 0.999], "strength": [0.767, 0.767, 0.767] })";
    const auto response = [&](double x) { return skin_edge_response(x / 10, false); };
    const double artist = edge_error(red, R"(, "kernel": "artist")" + world_unit(10), true, response);
    RecordProperty("artist", std::to_string(artist));
    EXPECT_GT(artist, 0.05);
    EXPECT_LT(artist, 0.12);
    EXPECT_LT(edge_error(red, R"(, "samples": 63)" + world_unit(10), true, response), 0.01);
}

TEST(SssSeparable, LeavesOfWavesOfLightWhatItsProfileDoes) {
    for (const double d : {8.0, 12.0, 16.0})
        for (const double wd : {0.1, 0.25, 0.5, 1.0, 2.0}) {
            // Whole waves in the part that is measured, whose margin is beyond the kernel's reach.
            const int waves = std::max(1, int(std::lround(wd / d * 256 / (2 * std::numbers::pi))));
            const double w = waves * 2 * std::numbers::pi / 256;
            const Image image =
                scatter(burley(d), R"(, "samples": 63)",
                        facing_plane(1024, 4, [&](double x, double) { return 1 + std::cos(w * x); }));
            double cosine = 0, sine = 0;
            for (int i = 384; i < 640; ++i) {
                cosine += image.at(i, 2, 0) * std::cos(w * (i - 511.5)) / 128;
                sine += image.at(i, 2, 0) * std::sin(w * (i - 511.5)) / 128;
            }
            EXPECT_NEAR(std::hypot(cosine, sine), reference::burley_modulation(w, d), 0.01)
                << d << " px, w d " << w * d;
        }
}

TEST(SssSeparable, KeepsEvenLightOnEachObject) {
    for (const char* kernel : {"preintegrated", "gaussian_fit", "artist"})
        for (const char* missing : {"own", "found"}) {
            const Capture capture = ball_before_wall(0.7f, 3.3f);
            const Image image = scatter(
                burley(9), R"(, "kernel": ")" + std::string(kernel) + R"(", "missing": ")" + missing + "\"",
                capture);
            for (int y = 0; y < 96; ++y)
                for (int x = 0; x < 128; ++x) {
                    const float before = capture.images.at("irradiance").at(x, y, 0);
                    ASSERT_NEAR(image.at(x, y, 0) / before, 1, 1e-3)
                        << kernel << " " << missing << " " << x << " " << y;
                }
        }
}

TEST(SssSeparable, KeepsTheLightOfASpotWithinThePlane) {
    for (const char* more : {R"(, "samples": 25)", R"(, "samples": 63)", R"(, "kernel": "artist")",
                             R"(, "kernel": "gaussian_fit")"})
        for (const double d : {0.05, 0.4, 6.0}) {
            const Capture capture =
                facing_plane(256, 256, [](double x, double y) { return std::hypot(x, y) < 5 ? 10.0 : 0.0; });
            const Image image = scatter(burley(d), more, capture);
            double before = 0, after = 0;
            for (int y = 0; y < 256; ++y)
                for (int x = 0; x < 256; ++x) {
                    before += capture.images.at("irradiance").at(x, y, 0);
                    after += image.at(x, y, 0);
                }
            EXPECT_NEAR(after / before, 1, 0.005) << more << " d " << d;
        }
}

/// The product of two lines is no round profile: where the edge runs at 45 degrees light comes out too far.
TEST(SssSeparable, IsOffBySomePercentForAnEdgeAt45Degrees) {
    const Image image =
        scatter(burley(8), R"(, "samples": 63)", facing_plane(400, 400, [](double x, double y) {
                    return x > y ? 1.0 : x < y ? 0.0 : 0.5;
                }));
    double most = 0;
    for (int i = 120; i < 280; ++i) {
        const double across = (i - (399 - i)) / std::numbers::sqrt2;
        most = std::max(most, std::abs(image.at(i, 399 - i, 0) - reference::burley_edge_response(across, 8)));
    }
    RecordProperty("diagonal", std::to_string(most));
    EXPECT_LT(most, 0.06);
}

/// A shadow's edge across the ball, the wall in even light: 10 lg of the mean square difference over the
/// ball, of 1.
double nearness_to_exact(const std::string& more) {
    Capture capture = ball_before_wall(1, 1);
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 128; ++x)
            if (capture.images["object_id"].uint_at(x, y, 0) == 2 && x < 2 * y - 40)
                detail::set_rgb(capture.images["irradiance"], x, y, {});
    const Image got = scatter(burley(4), more, capture);
    const std::string exact =
        R"({ "aftershade": 1, "steps": [ { "effect": "sss_exact", "params": { "scattering_profile": )" +
        burley(4) + " } } ] }";
    const Image expected = LookRunner(exact, gpu::test_backend()).run(capture).images.at("irradiance");
    double sum = 0, count = 0;
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 128; ++x) {
            if (capture.images.at("object_id").uint_at(x, y, 0) != 2) continue;
            sum += std::pow(got.at(x, y, 0) - expected.at(x, y, 0), 2);
            ++count;
        }
    return -10 * std::log10(sum / count);
}

TEST(SssSeparable, ComesNearToTheSumOverAllPixelsOnABall) {
    const double found = nearness_to_exact(""), own = nearness_to_exact(R"(, "missing": "own")");
    RecordProperty("psnr", std::to_string(found) + " " + std::to_string(own));
    EXPECT_GT(found, 28);
    EXPECT_GT(own, 28);
    EXPECT_GT(found, own);
}

/// Slanted by 60 degrees the plane's millimetres are half as many pixels.
TEST(SssSeparable, TakesDistancesOnTheSurface) {
    const double d_mm = 40, slope = std::tan(60 * std::numbers::pi / 180);
    Capture capture = facing_plane(512, 8, [](double x, double) { return x > 0 ? 1.0 : 0.0; });
    // A plane through (0, 0, -1) m: z = 1 + slope x at the line (x / z).
    const auto depth_at = [&](double x_px) { return 1 / (1 - slope * x_px * kPixel_mm / 1000); };
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 512; ++x) capture.images["depth"].at(x, y, 0) = float(depth_at(x + 0.5 - 256));
    const Image image =
        scatter(R"({ "type": "burley", "d_mm": [40, 40, 40] })", R"(, "samples": 63)", capture);
    for (int x = 200; x < 312; ++x) {
        const double across_mm = (x + 0.5 - 256) * kPixel_mm * depth_at(x + 0.5 - 256);
        EXPECT_NEAR(image.at(x, 4, 0),
                    reference::burley_edge_response(across_mm * std::hypot(1, slope), d_mm), 0.015)
            << x;
    }
}

}  // namespace
}  // namespace aftershade::test::sss_separable
