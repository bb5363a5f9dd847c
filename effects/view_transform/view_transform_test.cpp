// The view transforms against double-precision twins and published values.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "framework/compare/metrics.h"
#include "tests/look_runner.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test::view_transform {
namespace {

using Vec = std::array<double, 3>;

Image view(const Capture& capture, const std::string& params) {
    return run_step("view_transform", capture, params).images.at("display");
}

/// One pixel's display values.
Vec view_of(Rgb light, const std::string& params) {
    const Image out = view(make_capture({.width = 4, .height = 4, .background = light}), params);
    return {out.at(1, 1, 0), out.at(1, 1, 1), out.at(1, 1, 2)};
}

TEST(ViewTransform, SrgbIsThePiecewiseCurve) {
    for (const float light : {0.0f, 0.001f, 0.0031308f, 0.01f, 0.18f, 0.5f, 1.0f, 7.0f}) {
        const Vec display = view_of({light, light * 0.5f, light * 0.1f}, R"("transform": "srgb")");
        EXPECT_NEAR(display[0], srgb_of_clamped(light), 2e-6) << light;
        EXPECT_NEAR(display[1], srgb_of_clamped(light * 0.5), 2e-6) << light;
        EXPECT_NEAR(display[2], srgb_of_clamped(light * 0.1), 2e-6) << light;
    }
}

TEST(ViewTransform, ExposureCountsStops) {
    EXPECT_NEAR(view_of({0.1f, 0.1f, 0.1f}, R"("exposure": 2)")[0], srgb_of_clamped(0.4), 2e-6);
    EXPECT_NEAR(view_of({0.1f, 0.1f, 0.1f}, R"("exposure": "-1 ev")")[0], srgb_of_clamped(0.05), 2e-6);
}

/// Hill's fit in double precision, rows as published.
Vec aces(Vec light) {
    const double in[3][3] = {
        {0.59719, 0.35458, 0.04823}, {0.07600, 0.90834, 0.01566}, {0.02840, 0.13383, 0.83777}};
    const double out[3][3] = {
        {1.60475, -0.53108, -0.07367}, {-0.10208, 1.10813, -0.00605}, {-0.00327, -0.07276, 1.07602}};
    Vec fitted{}, result{};
    for (int i = 0; i < 3; ++i) {
        const double v = in[i][0] * light[0] + in[i][1] * light[1] + in[i][2] * light[2];
        fitted[std::size_t(i)] =
            (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    }
    for (int i = 0; i < 3; ++i)
        result[std::size_t(i)] =
            srgb_of_clamped(out[i][0] * fitted[0] + out[i][1] * fitted[1] + out[i][2] * fitted[2]);
    return result;
}

TEST(ViewTransform, AcesFollowsHillsFit) {
    for (const Rgb light :
         {Rgb{0.18f, 0.18f, 0.18f}, Rgb{1, 0.2f, 0.05f}, Rgb{0, 4, 0.5f}, Rgb{16, 16, 16}}) {
        const Vec display = view_of(light, R"("transform": "aces")");
        const Vec expected = aces({light.r, light.g, light.b});
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(display[c], expected[c], 1e-5) << light.r << " " << c;
    }
}

TEST(ViewTransform, AgxTakesMiddleGreyNearItsPlaceRisesAndWhitensBrightColors) {
    // AgX's curve has its pivot at middle grey, with y_pivot = 0.5 of the display; the polynomial is within
    // 0.01 of it.
    const Vec grey = view_of({0.18f, 0.18f, 0.18f}, R"("transform": "agx")");
    EXPECT_NEAR(grey[0], 0.5, 0.01);
    EXPECT_NEAR(grey[1], grey[0], 2e-3);
    double before = 0;
    for (int ev = -8; ev <= 5; ++ev) {
        const float light = 0.18f * std::exp2(float(ev));
        const double display = view_of({light, light, light}, R"("transform": "agx")")[1];
        EXPECT_GE(display, before) << ev;
        before = display;
    }
    const Vec red = view_of({60, 0.5f, 0.5f}, R"("transform": "agx")");
    EXPECT_GT(red[1], 0.5);  // a clipping transform would leave it a pure red
}

TEST(ViewTransform, TransformsTheColorNotTheColorTimesItsCoverage) {
    const Capture capture =
        make_capture({.width = 4, .height = 4, .background = {0.5f, 0.5f, 0.5f}, .alpha = 0.25f});
    const Image out = view(capture, R"("transform": "srgb")");
    EXPECT_NEAR(out.at(1, 1, 0), srgb_of_clamped(0.5), 2e-6);
    EXPECT_EQ(out.at(1, 1, 3), 0.25f);
}

TEST(ViewTransform, StaysWithinTheDisplay) {
    for (const char* transform : {"srgb", "aces", "agx"})
        for (const float light : {-5.0f, 0.0f, 1e-20f, 1e6f, 3e38f}) {
            const Vec display =
                view_of({light, light, light}, std::string(R"("transform": ")") + transform + "\"");
            for (const double value : display)
                EXPECT_TRUE(value >= 0 && value <= 1) << transform << " " << light << " " << value;
        }
}

}  // namespace
}  // namespace aftershade::test::view_transform
