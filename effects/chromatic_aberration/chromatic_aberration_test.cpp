// Where the channels of a point land, against the shift that the parameters ask for.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

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

/// Brings the mean place of red to 1.
double widening(int taps) {
    double red = 0, red_moment = 0;
    for (int i = 0; i < taps; ++i) {
        const double place = std::max(2.0 * i / (taps - 1) - 1, 0.0);
        red += place;
        red_moment += place * place;
    }
    return red / red_moment;
}

/// Mean of a channel's images, px right of the centre: each tap makes one of 1 + m times the size, which has
/// (1 + m)^2 times the light. `side` is 1 for red, 0 for green, -1 for blue.
double expected_x(double x, double amount_px, int taps, int side) {
    double light = 0, moment = 0;
    for (int i = 0; i < taps; ++i) {
        const double place = 2.0 * i / (taps - 1) - 1;
        const double weight = side == 0 ? 1 - std::abs(place) : std::max(side * place, 0.0);
        const double size = 1 + place * amount_px * widening(taps) / std::hypot(128, 72);
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

/// Between the centres of four texels, those beyond the edge as at the edge.
double between_texels(const Image& image, double x, double y, int channel) {
    const double column = std::floor(x - 0.5), row = std::floor(y - 0.5);
    const auto at = [&](double u, double v) {
        return double(image.at(std::clamp(int(u), 0, image.width() - 1),
                               std::clamp(int(v), 0, image.height() - 1), channel));
    };
    const double right = x - 0.5 - column, below = y - 0.5 - row;
    return std::lerp(std::lerp(at(column, row), at(column + 1, row), right),
                     std::lerp(at(column, row + 1), at(column + 1, row + 1), right), below);
}

/// The mean of all taps in double precision, with falloff 1.
double mean_of_taps(const Image& image, int x, int y, int channel, double amount_px, int taps) {
    const double half_width = image.width() / 2.0, half_height = image.height() / 2.0;
    double sum = 0, weights = 0;
    for (int i = 0; i < taps; ++i) {
        const double place = 2.0 * i / (taps - 1) - 1;
        const double size = 1 + place * amount_px * widening(taps) / std::hypot(half_width, half_height);
        const double weight = channel == 3   ? 1
                              : channel == 1 ? 1 - std::abs(place)
                                             : std::max(channel == 0 ? place : -place, 0.0);
        sum += weight * between_texels(image, half_width + (x + 0.5 - half_width) / size,
                                       half_height + (y + 0.5 - half_height) / size, channel);
        weights += weight;
    }
    return sum / weights;
}

TEST(ChromaticAberration, IsTheMeanOfAllItsTapsAlsoWhereTheyLieWithinAPixel) {
    Capture capture = make_capture({.width = 480, .height = 270});
    Image& noise = capture.images.at("color");
    std::uint32_t state = 1;
    for (int y = 0; y < noise.height(); ++y)
        for (int x = 0; x < noise.width(); ++x)
            for (int c = 0; c < 4; ++c) {
                state = state * 1664525U + 1013904223U;
                noise.at(x, y, c) = float(state >> 8) / float(1 << 24);
            }
    // Of the first two, the taps lie within a pixel at the centre, but not at the edges; of the last one,
    // nowhere.
    const std::pair<double, int> cases[] = {{1, 9}, {-1, 9}, {0.5, 33}, {0.5, 6}, {0.5, 3}, {6, 9}};
    for (const auto& [amount, taps] : cases) {
        const Image out = fringed(
            capture, R"("amount": )" + std::to_string(amount) + R"(, "taps": )" + std::to_string(taps));
        for (int y = 0; y < noise.height(); ++y)
            for (int x = y % 3; x < noise.width(); x += 3)
                for (int c = 0; c < 4; ++c)
                    ASSERT_NEAR(out.at(x, y, c), mean_of_taps(noise, x, y, c, amount, taps), 2e-4)
                        << amount << " " << taps << ": " << x << " " << y << " " << c;
    }
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
