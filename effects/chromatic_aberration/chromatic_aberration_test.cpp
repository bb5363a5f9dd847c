// Where the channels of a point land, against the shift that the parameters ask for.
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/crop.h"
#include "tests/look_runner.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test::chromatic_aberration {
namespace {

Image fringed(const Capture& capture, const std::string& params) {
    return run_step("chromatic_aberration", capture, params).images.at("color");
}

/// Mean x of a channel's light above the background, px.
double centre_x(const Image& image, int channel) {
    double sum = 0, moment = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            sum += image.at(x, y, channel);
            moment += double(image.at(x, y, channel)) * x;
        }
    return moment / sum;
}

/// On the row of the centre, 96 px right of it; the corner lies hypot(128, 72) = 146.9 px away.
Capture point() {
    return make_capture({.width = 256, .height = 144, .points = {{223, 72, 100}, {223, 71, 100}}});
}

/// Mean of a channel's images, px right of the centre: each tap makes one of 1 + m times the size, which has
/// (1 + m)^2 times the light. `side` is 1 for red, 0 for green, -1 for blue.
double expected_x(double x, double amount_px, int taps, int side) {
    double red = 0, red_moment = 0;
    for (int i = 0; i < taps; ++i) {
        const double place = 2.0 * i / (taps - 1) - 1;
        red += std::max(place, 0.0);
        red_moment += std::max(place, 0.0) * place;
    }
    double light = 0, moment = 0;
    for (int i = 0; i < taps; ++i) {
        const double place = 2.0 * i / (taps - 1) - 1;
        const double weight = side == 0 ? 1 - std::abs(place) : std::max(side * place, 0.0);
        const double size = 1 + place * amount_px * red / red_moment / std::hypot(128, 72);
        light += weight * size * size;
        moment += weight * size * size * size * x;
    }
    return moment / light;
}

TEST(ChromaticAberration, PartsRedAndBlueByTheAmountInTheCorner) {
    for (const int taps : {3, 9, 32})
        for (const double amount : {8.0, -8.0}) {
            const Image out = fringed(
                point(), R"("amount": )" + std::to_string(amount) + R"(, "taps": )" + std::to_string(taps));
            for (const int channel : {0, 1, 2})
                EXPECT_NEAR(centre_x(out, channel) - 127.5, expected_x(95.5, amount, taps, 1 - channel), 0.1)
                    << taps << " " << channel;
            // The figure that the parameter names, up to the second order in the magnification.
            EXPECT_NEAR(centre_x(out, 0) - 223, amount * 95.5 / std::hypot(128, 72), 0.35) << taps;
        }
}

TEST(ChromaticAberration, GrowsByThePowerOfFalloff) {
    const double place = 95.5 / std::hypot(128, 72);
    const Image out = fringed(point(), R"("amount": 16, "falloff": 3, "taps": 3)");
    // The mean is drawn outwards where the shift grows steeply: a point's image is stretched.
    EXPECT_NEAR(centre_x(out, 0) - 223, 16 * std::pow(place, 3), 1.0);
}

TEST(ChromaticAberration, LeavesWhatHasNoEdgesWhite) {
    const Capture capture = make_capture({.background = {0.5f, 0.5f, 0.5f}});
    const Image out = fringed(capture, R"("amount": 10, "taps": 16)");
    for (int y = 0; y < 36; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(out.at(x, y, c), 0.5, 1e-6);
}

TEST(ChromaticAberration, IsCentredOnTheDisplayWindowWhateverTheCrop) {
    const Window window{180, 40, 255, 110};
    const Image whole = fringed(point(), R"("amount": 6)"),
                part = fringed(cropped(point(), window), R"("amount": 6)");
    for (int y = 8; y < part.height() - 8; ++y)
        for (int x = 8; x < part.width() - 8; ++x)
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(part.at(x, y, c), whole.at(x + window.min_x, y + window.min_y, c), 2e-3)
                    << x << " " << y;
}

}  // namespace
}  // namespace aftershade::test::chromatic_aberration
