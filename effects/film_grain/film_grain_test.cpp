// Grain's statistics against what they are made to be, and its numbers against a twin.
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "tests/backends.h"
#include "tests/crop.h"
#include "tests/look_runner.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test::film_grain {
namespace {

using Uvec3 = std::array<std::uint32_t, 3>;

Image grained(const Capture& capture, const std::string& params, const std::string& name = "grain") {
    const std::string look = R"({"aftershade": 1, "steps": [{"name": ")" + name +
                             R"(", "effect": "film_grain", "params": {)" + params + "}}]}";
    return LookRunner(look, gpu::test_backend()).color(capture);
}

Capture grey(float light, int frame = 1) {
    return make_capture({.width = 256, .height = 256, .background = {light, light, light}}, frame);
}

/// Mean of the light, and mean and deviation of its logarithm.
struct Statistics {
    double mean = 0, log_mean = 0, log_deviation = 0;
};

Statistics statistics_of(const Image& image, int channel) {
    Statistics s;
    const double count = double(image.width()) * image.height();
    double squares = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const double light = image.at(x, y, channel), logarithm = std::log(light);
            s.mean += light / count;
            s.log_mean += logarithm / count;
            squares += logarithm * logarithm / count;
        }
    s.log_deviation = std::sqrt(squares - s.log_mean * s.log_mean);
    return s;
}

TEST(FilmGrain, KeepsTheMeanAndHasTheDeviationAskedFor) {
    // 65,536 pixels: the mean's own deviation is 0.1 % of the light at intensity 0.2, more where grains are
    // larger.
    for (const double size : {1.0, 1.5, 3.0}) {
        const Image out = grained(grey(0.18f), R"("intensity": 0.2, "size": )" + std::to_string(size));
        for (int c = 0; c < 3; ++c) {
            const Statistics s = statistics_of(out, c);
            EXPECT_NEAR(s.mean, 0.18, 0.18 * 0.004 * size) << size;
            EXPECT_NEAR(s.log_deviation, 0.2, 0.004 * size) << size;
        }
    }
}

TEST(FilmGrain, FollowsTheLightByResponse) {
    const Image dark = grained(grey(0.045f), R"("intensity": 0.1, "size": 1, "response": 0.5)");
    EXPECT_NEAR(statistics_of(dark, 0).log_deviation, 0.2, 0.004);
    const Image bright = grained(grey(0.72f), R"("intensity": 0.1, "size": 1, "response": 0.5)");
    EXPECT_NEAR(statistics_of(bright, 0).log_deviation, 0.05, 0.001);
    const Image fine = grained(grey(0.18f), R"("intensity": 0.2, "size": 0.5)");
    EXPECT_NEAR(statistics_of(fine, 0).log_deviation, 0.1, 0.002);  // four grains in a pixel
}

double correlation(const Image& a, int channel_a, const Image& b, int channel_b) {
    const Statistics sa = statistics_of(a, channel_a), sb = statistics_of(b, channel_b);
    double sum = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x)
            sum += (std::log(a.at(x, y, channel_a)) - sa.log_mean) *
                   (std::log(b.at(x, y, channel_b)) - sb.log_mean);
    return sum / (a.width() * a.height() * sa.log_deviation * sb.log_deviation);
}

TEST(FilmGrain, DiffersBetweenChannelsFramesSeedsAndStepsButNotBetweenRuns) {
    const std::string params = R"("intensity": 0.2, "size": 1)";
    const Image first = grained(grey(0.18f), params);
    EXPECT_NEAR(correlation(first, 0, first, 1), 0, 0.02);
    EXPECT_NEAR(correlation(first, 1, first, 2), 0, 0.02);
    EXPECT_NEAR(correlation(first, 0, grained(grey(0.18f, 2), params), 0), 0, 0.02);
    EXPECT_NEAR(correlation(first, 0, grained(grey(0.18f), params + R"(, "seed": 1)"), 0), 0, 0.02);
    EXPECT_NEAR(correlation(first, 0, grained(grey(0.18f), params, "again"), 0), 0, 0.02);
    EXPECT_TRUE(same_in_window(first, grained(grey(0.18f), params), {0, 0, 255, 255}));
    const Image one = grained(grey(0.18f), params + R"(, "monochrome": true)");
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x) ASSERT_EQ(one.at(x, y, 0), one.at(x, y, 2));
}

TEST(FilmGrain, ACropHasTheGrainOfTheWhole) {
    const Window window{17, 40, 99, 80};
    EXPECT_TRUE(same_in_window(grained(grey(0.5f), ""), grained(cropped(grey(0.5f), window), ""), window));
}

// ---- a twin in double precision ----

Uvec3 pcg3d(Uvec3 v) {
    for (std::uint32_t& u : v) u = u * 1664525u + 1013904223u;
    const auto stir = [&] {
        v[0] += v[1] * v[2];
        v[1] += v[2] * v[0];
        v[2] += v[0] * v[1];
    };
    stir();
    for (std::uint32_t& u : v) u ^= u >> 16u;
    stir();
    return v;
}

double unit(std::uint32_t bits) {
    return ((bits >> 9u) + 0.5) / 8388608.0;
}

std::uint32_t fnv1a(const std::string& text) {
    std::uint32_t hash = 2166136261u;
    for (const unsigned char c : text) hash = (hash ^ c) * 16777619u;
    return hash;
}

double normal_of_cell(int x, int y, const Uvec3& key) {
    const Uvec3 a = pcg3d({std::uint32_t(x), std::uint32_t(y), key[0]});
    return std::sqrt(-2 * std::log(unit(a[0]))) * std::cos(2 * std::numbers::pi * unit(a[1]));
}

TEST(FilmGrain, EqualsItsTwinPixelByPixel) {
    const Image out =
        grained(grey(0.18f, 7), R"("intensity": 0.2, "size": 1, "seed": 5, "monochrome": true)");
    const Uvec3 key = pcg3d({7, fnv1a("grain"), 5});
    for (int y = 1; y < 40; ++y)
        for (int x = 1; x < 40; ++x) {
            double sum = 0, squares = 0;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const double weight = std::pow(1 - (dx * dx + dy * dy) / 2.25, 4);
                    sum += weight * normal_of_cell(x + dx, y + dy, key);
                    squares += weight * weight;
                }
            const double expected = 0.18 * std::exp(0.2 * sum / std::sqrt(squares) - 0.02);
            ASSERT_NEAR(out.at(x, y, 0), expected, 1e-5) << x << " " << y;
        }
}

}  // namespace
}  // namespace aftershade::test::film_grain
