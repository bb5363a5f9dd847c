// Light through thin parts against the formula in double.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "tests/backends.h"
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
        gpu::test_backend(), {"transmittance.irradiance"});
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

/// A slab of `thickness_m` whose front is turned by `angle` about the y axis and crosses the view axis at 1
/// m, seen by a lens of 50 mm on 36 mm: its two sides as two layers, without a thickness.
Capture slab(double thickness_m, double angle) {
    Capture capture = thin();
    capture.images.erase("aov:thickness");
    std::erase(capture.header.roles, "aov:thickness");
    capture.header.camera.set("focal_length", 50);
    capture.header.camera.set("sensor_width", 36);
    Image& front = capture.images.at("depth");
    Image back(kWidth, kHeight, 1), ids(kWidth, kHeight, 1, ComponentType::uint32);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            // The plane n p = -cos(angle) d meets the line (X, Y, -1) z where z = cos d / (cos - sin X).
            const double line_x = (x + 0.5 - kWidth / 2.0) * 36 / 50 / kWidth;
            const double facing = std::cos(angle) - std::sin(angle) * line_x;
            front.at(x, y, 0) = float(std::cos(angle) / facing);
            back.at(x, y, 0) = float((std::cos(angle) + thickness_m) / facing);
            ids.uint_at(x, y, 0) = capture.images.at("object_id").uint_at(x, y, 0);
        }
    capture.images[RoleId::of_layer(1, "depth")] = std::move(back);
    capture.images[RoleId::of_layer(1, "object_id")] = std::move(ids);
    capture.header.layer_count = 2;
    for (const char* role : {"depth", "object_id"})
        capture.header.layer_roles.push_back(RoleId::of_layer(1, role));
    return capture;
}

TEST(Transmittance, TakesTheThicknessOfASlabFromItsSecondLayerFromAnySide) {
    for (const double angle : {0.0, 0.5, -1.0})
        for (const double thickness_m : {0.0002, 0.001, 0.003}) {
            const Capture layered = slab(thickness_m, angle);
            const Image light = transmitted(layered);
            double most = 0;
            for (int y = 0; y < kHeight; ++y)
                for (int x = 1; x + 1 < kWidth; ++x)
                    for (int c = 0; c < 3; ++c) {
                        const double intensity[] = {3, 2, 1};
                        const double cosine = layered.images.at("normal").at(x, y, 2);
                        const double more = std::clamp(0.3 - cosine, 0.0, 1.0) * intensity[c] / kPi *
                                            through(1000 * thickness_m, c);
                        const double before = layered.images.at("irradiance").at(x, y, c);
                        // Depth has 24 bits: 6e-8 of 1 m is 6e-4 of the thinnest slab; slopes are halves.
                        ASSERT_NEAR(light.at(x, y, c), before + more, 5e-3 * more + 2e-6)
                            << angle << " " << thickness_m << ": " << x << " " << y << " " << c;
                        most = std::max(most, more);
                    }
            EXPECT_GT(most, 0.02) << thickness_m;
        }
}

TEST(Transmittance, LetsNothingThroughFromAnObjectBehindOrFromNothing) {
    Capture layered = slab(0.001, 0.3);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            if (x < kWidth / 2) layered.images.at(RoleId::of_layer(1, "object_id")).uint_at(x, y, 0) = 7;
            else if (x > kWidth / 2)
                layered.images.at(RoleId::of_layer(1, "depth")).at(x, y, 0) =
                    std::numeric_limits<float>::infinity();
        }
    const Image light = transmitted(layered);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            if (x == kWidth / 2) continue;
            ASSERT_EQ(light.at(x, y, 1), layered.images.at("irradiance").at(x, y, 1)) << x << " " << y;
        }
    EXPECT_GT(light.at(kWidth / 2, kHeight - 1, 1),
              layered.images.at("irradiance").at(kWidth / 2, kHeight - 1, 1));
}

TEST(Transmittance, WithoutAThicknessAndASecondLayerNamesBoth) {
    Capture capture = thin();
    capture.images.erase("aov:thickness");
    std::erase(capture.header.roles, "aov:thickness");
    try {
        transmitted(capture);
        FAIL() << "ran";
    } catch (const std::exception& error) {
        EXPECT_NE(std::string(error.what()).find("needs the role 'aov:thickness' or 'layer1:depth'"),
                  std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace aftershade::test::transmittance
