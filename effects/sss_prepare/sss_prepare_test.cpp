// The albedo's part of the light that scatters, in double.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/backends.h"
#include "tests/look_runner.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test::sss_prepare {
namespace {

Capture varied() {
    Capture capture = make_capture({.width = 24, .height = 8});
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 24; ++x)
            for (int c = 0; c < 3; ++c) {
                capture.images.at("albedo").at(x, y, c) = float(x) / 23;
                capture.images.at("irradiance").at(x, y, c) = 0.25f * float(y) + float(c);
            }
    return capture;
}

TEST(SssPrepare, MultipliesLightByThePartOfTheAlbedoThatScatters) {
    const Capture capture = varied();
    const std::pair<const char*, double> powers[] = {{"post", 0}, {"pre_and_post", 0.5}, {"pre", 1}};
    for (const auto& [texturing, power] : powers) {
        LookRunner runner(
            R"({"aftershade": 1, "steps": [{"effect": "sss_prepare", "params": {"texturing": ")" +
                std::string(texturing) + R"("}}]})",
            gpu::test_backend(), {"sss_prepare.irradiance"});
        const Image light = runner.run(capture).taps.at("sss_prepare.irradiance");
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 24; ++x)
                for (int c = 0; c < 3; ++c) {
                    const double own = capture.images.at("irradiance").at(x, y, c);
                    const double expected =
                        std::pow(double(capture.images.at("albedo").at(x, y, c)), power) * own;
                    ASSERT_NEAR(light.at(x, y, c), expected, 1e-6) << texturing << " " << x << " " << y;
                    if (power == 0) {
                        ASSERT_EQ(light.at(x, y, c), float(own));
                    }
                }
    }
}

}  // namespace
}  // namespace aftershade::test::sss_prepare
