// Light through thin parts against the formula in double.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "tests/look_runner.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test::transmittance {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kWidth = 32, kHeight = 24;

/// Lines of normals that turn from the light to away from it, columns of thickness from 0 to 31 tenths of a
/// mm.
Capture thin() {
    Capture capture = make_capture({.width = kWidth, .height = kHeight, .background_depth_m = 2});
    capture.images["aov:thickness"] = Image(kWidth, kHeight, 4);
    capture.header.roles.push_back("aov:thickness");
    capture.images.erase("mask");
    std::erase(capture.header.roles, "mask");
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const double angle = y * kPi / (kHeight - 1);
            const float normal[3] = {float(std::sin(angle)), 0, float(std::cos(angle))};
            for (int c = 0; c < 3; ++c) {
                capture.images.at("normal").at(x, y, c) = normal[c];
                capture.images.at("irradiance").at(x, y, c) = 0.1f * float(c);
            }
            capture.images.at("aov:thickness").at(x, y, 0) = 1e-4f * float(x);
        }
    CaptureLight sun;
    sun.kind = CaptureLight::Kind::directional;
    sun.direction = {0, 0, -1};
    sun.intensity = {3, 2, 1};
    capture.header.lights = {sun};
    return capture;
}

Image transmitted(const Capture& capture, const std::string& params = "") {
    LookRunner runner(
        R"({"aftershade": 1, "steps": [{"effect": "transmittance", "params": {)" + params + "}}]}",
        gpu::Backend::software, {"transmittance.irradiance"});
    return runner.run(capture).taps.at("transmittance.irradiance");
}

/// d'Eon and Luebke's skin through `mm`, as Jimenez has it.
double through(double mm, int c) {
    const double gaussians[6][4] = {{0.0064, 0.233, 0.455, 0.649}, {0.0484, 0.100, 0.336, 0.344},
                                    {0.187, 0.118, 0.198, 0},      {0.567, 0.113, 0.007, 0.007},
                                    {1.99, 0.358, 0.004, 0},       {7.41, 0.078, 0, 0}};
    double sum = 0;
    for (const auto& g : gaussians) sum += g[c + 1] * std::exp(-mm * mm / g[0]);
    return sum;
}

double expected(const Capture& capture, int x, int y, int c, double toward_z, double light, double wrap,
                double mm_per_m) {
    const double cosine = capture.images.at("normal").at(x, y, 2) * toward_z;
    const double thickness_m = capture.images.at("aov:thickness").at(x, y, 0);
    const double behind = std::clamp(wrap - cosine, 0.0, 1.0);
    return thickness_m > 0 ? behind * light / kPi * through(thickness_m * mm_per_m, c) : 0;
}

TEST(Transmittance, IsTheFormulaOfThicknessNormalAndLight) {
    const Capture capture = thin();
    const double intensity[] = {3, 2, 1};
    const Image light = transmitted(capture);
    const Image thicker = transmitted(capture, R"("wrap": 0, "thickness_scale": 2, "world_unit": 500)");
    double most = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (int c = 0; c < 3; ++c) {
                const double before = capture.images.at("irradiance").at(x, y, c);
                const double more = expected(capture, x, y, c, 1, intensity[c], 0.3, 1000);
                ASSERT_NEAR(light.at(x, y, c), before + more, 2e-6) << x << " " << y << " " << c;
                ASSERT_NEAR(thicker.at(x, y, c),
                            before + expected(capture, x, y, c, 1, intensity[c], 0, 1000), 2e-6);
                most = std::max(most, more);
            }
    EXPECT_GT(most, 0.5);
}

TEST(Transmittance, LeavesWhatHasNoThicknessOrDoesNotScatterBitForBit) {
    Capture capture = thin();
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            if (x % 2) capture.images.at("aov:thickness").at(x, y, 0) = x % 4 == 1 ? 0.0f : -1.0f;
            else if (x % 4 == 2) capture.images.at("object_id").uint_at(x, y, 0) = 5;
        }
    const Image light = transmitted(capture, R"("object_ids": [0])");
    int changed = 0;
    for (int x = 1; x < kWidth; ++x)
        for (int y = 0; y < kHeight; ++y) {
            const float a = light.at(x, y, 1), b = capture.images.at("irradiance").at(x, y, 1);
            const bool same = std::memcmp(&a, &b, sizeof a) == 0;
            if (x % 4) ASSERT_TRUE(same) << x << " " << y;
            else changed += !same;
        }
    EXPECT_GT(changed, 50);
}

TEST(Transmittance, TakesTheLooksLightWhereTheCaptureHasNone) {
    Capture capture = thin();
    const Image known = transmitted(capture);
    capture.header.lights.clear();
    const Image light =
        transmitted(capture, R"("light_direction": [0, 0, -7], "light_intensity": [3, 2, 1])");
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            ASSERT_NEAR(light.at(x, y, 0), known.at(x, y, 0), 1e-6) << x << " " << y;
}

TEST(Transmittance, LetsNothingThroughWhatIsInfinitelyThick) {
    Capture capture = thin();
    for (float& value : capture.images.at("aov:thickness").floats())
        value = std::numeric_limits<float>::infinity();
    const Image light = transmitted(capture);
    for (int x = 0; x < kWidth; ++x)
        ASSERT_EQ(light.at(x, kHeight - 1, 2), capture.images.at("irradiance").at(x, kHeight - 1, 2));
}

}  // namespace
}  // namespace aftershade::test::transmittance
