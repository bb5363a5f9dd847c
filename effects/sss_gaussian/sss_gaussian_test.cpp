// A sum of Gaussian blurs: against sums of error functions on planes, in screen and in texture space.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "framework/file/exr_file.h"
#include "framework/scattering/scattering_profile.h"
#include "tests/cli/command.h"
#include "tests/look_runner.h"
#include "tests/scattering_checks.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test::sss_gaussian {
namespace {

constexpr double kPixel_mm = kFacingPlanePixel_mm;

ScatteringProfile profile_of(const std::string& text) {
    Diagnostics diagnostics;
    const auto node = parse_document(text, "profile", diagnostics);
    const auto profile = node ? parse_scattering_profile(*node, "profile", {}, diagnostics) : std::nullopt;
    if (!profile) throw std::runtime_error("no profile: " + text);
    return *profile;
}

/// `more`: further parameters, each behind a comma.
std::string look(const std::string& profile, const std::string& more = "") {
    return scattering_step("sss_gaussian", profile + more);
}

Image scatter(const std::string& profile, const std::string& more, const Capture& capture) {
    return scattered(look(profile, more), capture);
}

/// Light beside a straight edge, of the profile's Gaussians.
class EdgeResponse {
public:
    explicit EdgeResponse(const std::string& profile)
        : direct_(profile_of(profile).direct), gaussians_(profile_of(profile).as_gaussians()) {}
    double operator()(int channel, double x_mm) const {
        const auto c = std::size_t(channel);
        double sum = direct_[c] * (x_mm > 0 ? 1 : 0);
        for (const ScatteringGaussian& gaussian : gaussians_)
            sum += gaussian.weight[c] * 0.5 * (1 + std::erf(x_mm / std::sqrt(2 * gaussian.variance_mm2[c])));
        return sum;
    }

private:
    aftershade::Rgb direct_;
    std::vector<ScatteringGaussian> gaussians_;
};

/// The most that any channel is off across an edge of light along columns or rows.
double edge_error(const std::string& profile, double mm_per_px, const std::string& more, bool along_x) {
    const int size = 512;
    const Capture capture = along_x
                                ? facing_plane(size, 8, [](double x, double) { return x > 0 ? 1.0 : 0.0; })
                                : facing_plane(8, size, [](double, double y) { return y > 0 ? 1.0 : 0.0; });
    const std::string unit = R"(, "world_unit": )" + std::to_string(1000 * mm_per_px / kPixel_mm);
    const Image image = scatter(profile, unit + more, capture);
    const EdgeResponse expected(profile);
    double most = 0;
    for (int i = size / 4; i < size * 3 / 4; ++i)
        for (int c = 0; c < 3; ++c) {
            const double got = along_x ? image.at(i, 4, c) : image.at(4, i, c);
            most = std::max(most, std::abs(got - expected(c, (i + 0.5 - size / 2) * mm_per_px)));
        }
    return most;
}

const char* const kSpaces[] = {R"(, "space": "screen")", R"(, "space": "texture")"};
const std::string kWax = R"({ "type": "burley", "d_mm": [16, 12, 8] })";

TEST(SssGaussian, SpreadsAnEdgeOfLightBySumsOfErrorFunctions) {
    for (const char* space : kSpaces)
        for (const bool along_x : {true, false}) {
            // Skin where its narrowest Gaussian is a 25th, a pixel and two pixels wide.
            for (const double mm_per_px : {0.5, 0.08, 0.04}) {
                const double error = edge_error(R"("skin")", mm_per_px, space, along_x);
                EXPECT_LT(error, 0.01) << space << " " << along_x << ", skin " << mm_per_px << " mm";
            }
            for (const double mm_per_px : {1.0, 4.0})
                EXPECT_LT(edge_error(kWax, mm_per_px, space, along_x), 0.01)
                    << space << " " << along_x << ", wax " << mm_per_px << " mm";
        }
}

TEST(SssGaussian, KeepsTheArtistsDirectShareWhereItIs) {
    EXPECT_LT(edge_error(R"({ "type": "artist", "falloff": [1, 0.37, 0.3], "strength": [0.48, 0.41, 0.28] })",
                         0.1, "", true),
              0.01);
}

TEST(SssGaussian, OrdersGaussiansByWidth) {
    const std::string unordered =
        R"({ "type": "gaussians", "gaussians": [ { "variance_mm2": 9, "weight": [0.5, 0, 0.2] },
        { "variance_mm2": 0.5, "weight": [0.2, 1, 0] }, { "variance_mm2": 2, "weight": [0.3, 0, 0.8] } ] })";
    EXPECT_LT(edge_error(unordered, 0.3, "", true), 0.01);
}

TEST(SssGaussian, KeepsEvenLightOnEachObject) {
    for (const char* space : kSpaces) {
        const Capture capture = ball_before_wall(0.7f, 3.3f);
        const Image image = scatter(kWax, space, capture);
        for (int y = 0; y < 96; ++y)
            for (int x = 0; x < 128; ++x)
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(image.at(x, y, c) / capture.images.at("irradiance").at(x, y, c), 1, 1e-3)
                        << space << " " << x << " " << y;
    }
}

TEST(SssGaussian, KeepsTheLightOfASpotWithinThePlane) {
    for (const double mm_per_px : {200.0, 20.0, 2.0}) {
        const Capture capture =
            facing_plane(256, 256, [](double x, double y) { return std::hypot(x, y) < 5 ? 10.0 : 0.0; });
        const Image image =
            scatter(R"({ "type": "burley", "d_mm": [10, 10, 5] })",
                    R"(, "world_unit": )" + std::to_string(1000 * mm_per_px / kPixel_mm), capture);
        for (const int c : {0, 2}) {
            double before = 0, after = 0;
            for (int y = 0; y < 256; ++y)
                for (int x = 0; x < 256; ++x) {
                    before += capture.images.at("irradiance").at(x, y, c);
                    after += image.at(x, y, c);
                }
            EXPECT_NEAR(after / before, 1, 0.005) << mm_per_px << " mm, channel " << c;
        }
    }
}

/// Gaussians are round: an edge that runs at 45 degrees spreads as one along a row.
TEST(SssGaussian, SpreadsAnEdgeAt45DegreesAlike) {
    const Capture capture = facing_plane(400, 400, [](double x, double y) {
        return x > y ? 1.0 : x < y ? 0.0 : 0.5;
    });
    const Image image = scatter(kWax, R"(, "world_unit": 500)", capture);
    const EdgeResponse expected(kWax);
    for (int i = 120; i < 280; ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(image.at(i, 399 - i, c), expected(c, (2 * i - 399) / std::sqrt(2.0)), 0.012)
                << i << " " << c;
}

/// Slanted by 60 degrees the plane's millimetres are half as many pixels.
TEST(SssGaussian, TakesDistancesOnTheSurface) {
    const double slope = std::tan(std::acos(-1.0) / 3);
    Capture capture = facing_plane(512, 8, [](double x, double) { return x > 0 ? 1.0 : 0.0; });
    const auto depth_at = [&](double x_px) { return 1 / (1 - slope * x_px * kPixel_mm / 1000); };
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 512; ++x) capture.images["depth"].at(x, y, 0) = float(depth_at(x + 0.5 - 256));
    const std::string text = R"({ "type": "burley", "d_mm": [40, 30, 20] })";
    const Image image = scatter(text, "", capture);
    const EdgeResponse expected(text);
    for (int x = 200; x < 312; ++x)
        for (int c = 0; c < 3; ++c) {
            const double across_mm = (x + 0.5 - 256) * kPixel_mm * depth_at(x + 0.5 - 256);
            EXPECT_NEAR(image.at(x, 4, c), expected(c, across_mm * std::hypot(1, slope)), 0.015)
                << x << " " << c;
        }
}

/// A rectangle whose texture is squeezed: its texels are twice as wide as high. From the command line.
TEST(SssGaussian, ScattersOnATextureThatTheRendererMade) {
    const TemporaryFolder folder;
    write_text(folder / "scene.json", R"({ "aftershade": 1, "size": [64, 36],
        "camera": { "position": [0, 0, 5] },
        "objects": [ { "name": "sheet", "shape": "plane", "size": [0.8, 0.4] } ],
        "lights": [ { "type": "directional", "position": [0, 0, 1], "intensity": 3.14159265, "shadows": false,
                      "pattern": { "type": "edge", "axis": [1, 0, 0], "offset": 0 } } ] })");
    const std::string profile = R"({ "type": "burley", "d_mm": [20, 10, 5] })";
    write_text(folder / "look.json", look(profile, R"(, "space": "texture")"));
    const int size = 200;
    const CommandResult rendered = run_aftershade({"render", "scene.json", "--space", "uv", "--object",
                                                   "sheet", "--texture-size", "200", "-o", "sheet"},
                                                  folder.path());
    ASSERT_EQ(rendered.exit_code, 0) << rendered.err;
    const CommandResult ran =
        run_aftershade({"run", "look.json", "sheet/capture.json", "-o", "out.exr", "--output-roles",
                        "irradiance,position", "--pixel-type", "float"},
                       folder.path());
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    const ExrFile file(folder / "out.exr");
    const std::vector<std::string> light = {"irradiance.R", "irradiance.G", "irradiance.B"},
                                   across = {"position.X"};
    const Image image = file.read_floats(0, light), position = file.read_floats(0, across);
    const EdgeResponse expected(profile);
    double most = 0;
    for (int x = size / 4; x < size * 3 / 4; ++x)
        for (int c = 0; c < 3; ++c)
            most = std::max(
                most, std::abs(image.at(x, size / 2, c) - expected(c, 1000.0 * position.at(x, size / 2, 0))));
    EXPECT_LT(most, 0.01);
}

}  // namespace
}  // namespace aftershade::test::sss_gaussian
