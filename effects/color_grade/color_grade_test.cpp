// The grade against the published formulas in double precision.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/look_runner.h"
#include "tests/synthetic_capture.h"
#include "tests/temporary_folder.h"

namespace aftershade::test::color_grade {
namespace {

using Vec = std::array<double, 3>;

Image graded(const Capture& capture, const std::string& params) {
    return run_step("color_grade", capture, params).images.at("color");
}

Vec graded(Rgb light, const std::string& params) {
    const Image out = graded(make_capture({.width = 4, .height = 4, .background = light}), params);
    return {out.at(1, 1, 0), out.at(1, 1, 1), out.at(1, 1, 2)};
}

/// ASC CDL v1.2: out = (in * slope + offset) ^ power, then saturation about Rec. 709's luminance.
Vec cdl(Vec in, bool clamps) {
    const Vec slope{1.3, 0.9, 0.7}, offset{-0.05, 0.02, 0.1}, power{1.2, 0.8, 1.5};
    const auto limited = [&](double v) { return clamps ? std::clamp(v, 0.0, 1.0) : v; };
    Vec v{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double linear = limited(in[i] * slope[i] + offset[i]);
        v[i] = linear > 0 ? std::pow(linear, power[i]) : linear;
    }
    const double luma = 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2];
    for (double& channel : v) channel = limited(luma + 1.4 * (channel - luma));
    return v;
}

TEST(ColorGrade, FollowsTheAscCdl) {
    const std::string params =
        R"("slope": [1.3, 0.9, 0.7], "offset": [-0.05, 0.02, 0.1], "power": [1.2, 0.8, 1.5], "saturation": 1.4)";
    for (const Rgb light : {Rgb{0.18f, 0.18f, 0.18f}, Rgb{0.9f, 0.05f, 0.3f}, Rgb{0.01f, 2, 8}}) {
        const Vec in{light.r, light.g, light.b};
        const Vec scene = graded(light, params), clamped = graded(light, params + R"(, "range": "cdl")");
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(scene[c], cdl(in, false)[c], 1e-4 * (1 + std::abs(cdl(in, false)[c]))) << light.g;
            EXPECT_NEAR(clamped[c], cdl(in, true)[c], 1e-4) << light.g;
        }
    }
}

/// Swaps red and blue, whatever curve lies around it; of two points a channel.
TEST(ColorGrade, GoesThroughACubeTableInItsOwnCurve) {
    const TemporaryFolder folder;
    write_text(folder / "swap.cube",
               "LUT_3D_SIZE 2\n0 0 0\n0 0 1\n0 1 0\n0 1 1\n1 0 0\n1 0 1\n1 1 0\n1 1 1\n");
    const std::string lut = R"("lut": ")" + (folder / "swap.cube").string() + '"';
    for (const char* space : {"srgb", "linear", "acescct"}) {
        const Vec out = graded({0.7f, 0.2f, 0.05f}, lut + R"(, "lut_space": ")" + space + '"');
        EXPECT_NEAR(out[0], 0.05, 2e-6) << space;
        EXPECT_NEAR(out[1], 0.2, 2e-6) << space;
        EXPECT_NEAR(out[2], 0.7, 4e-6) << space;
    }
    EXPECT_NEAR(graded({40, 1, 2}, lut + R"(, "lut_space": "acescct")")[2], 40, 4e-4)
        << "light above 1 is kept";
    EXPECT_NEAR(graded({40, 1, 2}, lut)[2], 1, 1e-5) << "srgb ends at 1";
    EXPECT_NEAR(graded({0.7f, 0.2f, 0.1f}, lut + R"(, "lut_amount": 0.25)")[0], 0.75 * 0.7 + 0.25 * 0.1,
                4e-6);
}

TEST(ColorGrade, ContrastIsAPowerAboutThePivot) {
    EXPECT_NEAR(graded({0.18f, 0.09f, 0.72f}, R"("contrast": 1.5)")[0], 0.18, 1e-6);
    EXPECT_NEAR(graded({0.18f, 0.09f, 0.72f}, R"("contrast": 1.5)")[1], 0.18 * std::pow(0.5, 1.5), 1e-6);
    EXPECT_NEAR(graded({0.18f, 0.09f, 0.72f}, R"("contrast": 1.5)")[2], 0.18 * 8, 1e-5);
    EXPECT_NEAR(graded({0.1f, 0.4f, 0.4f}, R"("exposure": -2)")[1], 0.1, 1e-7);
}

/// CIE 1931 xy of black bodies by Planck's law, rounded to four places.
struct BlackBody {
    int kelvin;
    double x, y;
};
constexpr BlackBody kBlackBodies[] = {
    {3000, 0.4369, 0.4041}, {4000, 0.3804, 0.3767}, {10000, 0.2806, 0.2883}};

/// Linear Rec. 709 of a light of luminance 1 (ITU-R BT.709-6, inverse of its matrix to XYZ).
Vec rec709_of_xy(double x, double y) {
    const Vec xyz{x / y, 1, (1 - x - y) / y};
    return {3.2409699 * xyz[0] - 1.5373832 * xyz[1] - 0.4986108 * xyz[2],
            -0.9692436 * xyz[0] + 1.8759675 * xyz[1] + 0.0415551 * xyz[2],
            0.0556301 * xyz[0] - 0.2039770 * xyz[1] + 1.0569715 * xyz[2]};
}

TEST(ColorGrade, MakesTheLightOfItsTemperatureNeutralAndKeepsItsLuminance) {
    const Vec neutral = rec709_of_xy(0.3135, 0.3236);  // a black body of 6500 K
    for (const BlackBody& body : kBlackBodies) {
        const Vec light = rec709_of_xy(body.x, body.y);
        const Vec out = graded({float(light[0]), float(light[1]), float(light[2])},
                               R"("temperature": )" + std::to_string(body.kelvin));
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(out[c], neutral[c], 0.01) << body.kelvin << " " << c;
        EXPECT_NEAR(0.2126 * out[0] + 0.7152 * out[1] + 0.0722 * out[2], 1, 2e-3) << body.kelvin;
    }
}

TEST(ColorGrade, WarmsWithTemperatureAndTurnsMagentaWithTint) {
    const Vec warm = graded({0.5f, 0.5f, 0.5f}, R"("temperature": 9000)");
    EXPECT_GT(warm[0], 0.52);
    EXPECT_LT(warm[2], 0.45);
    const Vec magenta = graded({0.5f, 0.5f, 0.5f}, R"("tint": 50)");
    EXPECT_LT(magenta[1], 0.49);
    EXPECT_GT(magenta[0], 0.51);
    EXPECT_GT(magenta[2], 0.51);
}

TEST(ColorGrade, GradesTheColorNotTheColorTimesItsCoverage) {
    const Capture capture =
        make_capture({.width = 4, .height = 4, .background = {0.5f, 0.5f, 0.5f}, .alpha = 0.25f});
    const Image out = graded(capture, R"("offset": [0.1, 0, 0], "contrast": 2)");
    EXPECT_NEAR(out.at(1, 1, 0), (0.18 * std::pow(0.5 / 0.18, 2) + 0.1) * 0.25, 1e-5);
    EXPECT_EQ(out.at(1, 1, 3), 0.25f);
    const Image empty =
        graded(make_capture({.width = 4, .height = 4, .alpha = 0}), R"("offset": [0.1, 0.1, 0.1])");
    EXPECT_EQ(empty.at(1, 1, 0), 0);
}

}  // namespace
}  // namespace aftershade::test::color_grade
