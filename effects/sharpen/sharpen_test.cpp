// Sharpening against a double-precision twin, and its promises: no halo beyond the neighbours, flat stays
// flat.
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/backends.h"
#include "tests/look_runner.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test::sharpen {
namespace {

constexpr int kWidth = 48, kHeight = 32;

Image sharpened(const Capture& capture, const std::string& params) {
    const std::string look =
        R"({"aftershade": 1, "steps": [{"effect": "sharpen", "params": {)" + params + "}}]}";
    return LookRunner(look, gpu::test_backend()).color(capture);
}

/// Soft waves, a hard edge to a lamp, and a little light below 0.
Capture picture() {
    Capture capture = make_capture({.width = kWidth, .height = kHeight});
    Image& color = capture.images["color"];
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const double wave = 0.4 + 0.3 * std::sin(x * 0.7) * std::cos(y * 0.45);
            color.at(x, y, 0) = float(wave);
            color.at(x, y, 1) = x > 30 && y > 20 ? 200.0f : float(0.5 * wave);
            color.at(x, y, 2) = float(wave - 0.2);
        }
    return capture;
}

double compressed(double light) {
    return light / (1 + std::abs(light));
}

double compressed_at(const Image& image, int x, int y, int c) {
    return compressed(image.at(std::clamp(x, 0, kWidth - 1), std::clamp(y, 0, kHeight - 1), c));
}

/// Light of a compressed value, within 0 and (1 + amount) times what it was.
double expanded(double value, double was, double amount) {
    const double sign = was < 0 ? -1 : 1, v = value * sign, most = std::abs(was) * (1 + amount);
    return sign * (v >= 1 ? most : std::clamp(v < 0 ? 0 : v / (1 - v), 0.0, most));
}

TEST(Sharpen, UnsharpEqualsItsTwin) {
    const Capture capture = picture();
    const Image& in = capture.images.at("color");
    const Image out = sharpened(capture, R"("amount": 1.5, "radius": 1.2, "limit": false)");
    const int reach = int(std::ceil(3 * 1.2));
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (int c = 0; c < 3; ++c) {
                double sum = 0, weights = 0;
                for (int dy = -reach; dy <= reach; ++dy)
                    for (int dx = -reach; dx <= reach; ++dx) {
                        const double weight = std::exp(-0.5 * (dx * dx + dy * dy) / (1.2 * 1.2));
                        sum += weight * compressed_at(in, x + dx, y + dy, c);
                        weights += weight;
                    }
                const double own = compressed_at(in, x, y, c);
                const double expected = expanded(own + 1.5 * (own - sum / weights), in.at(x, y, c), 1.5);
                ASSERT_NEAR(out.at(x, y, c), expected, 2e-5 * (1 + std::abs(expected) * std::abs(expected)))
                    << x << " " << y << " " << c;
            }
}

/// AMD's own form: every neighbour weighs peak, the pixel 1, divided by their sum.
TEST(Sharpen, CasWeighsTheCrossAsAmdDoes) {
    const Capture capture = picture();
    const Image& in = capture.images.at("color");
    const Image out = sharpened(capture, R"("method": "cas", "amount": 1, "limit": false)");
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const double e = compressed_at(in, x, y, 0),
                         n[4] = {compressed_at(in, x, y - 1, 0), compressed_at(in, x - 1, y, 0),
                                 compressed_at(in, x + 1, y, 0), compressed_at(in, x, y + 1, 0)};
            const double least = std::min({e, n[0], n[1], n[2], n[3]}),
                         most = std::max({e, n[0], n[1], n[2], n[3]});
            const double peak = -0.2 * std::sqrt(std::clamp(std::min(least, 1 - most) / most, 0.0, 1.0));
            const double sharp = (e + peak * (n[0] + n[1] + n[2] + n[3])) / (1 + 4 * peak);
            ASSERT_NEAR(out.at(x, y, 0), expanded(sharp, in.at(x, y, 0), 1), 1e-5) << x << " " << y;
        }
}

TEST(Sharpen, WithLimitGoesNotBeyondTheNeighbours) {
    const Capture capture = picture();
    const Image& in = capture.images.at("color");
    for (const char* method : {"unsharp", "cas"}) {
        const Image out =
            sharpened(capture, R"("amount": 8, "limit": true, "method": ")" + std::string(method) + '"');
        bool changed = false;
        for (int y = 1; y < kHeight - 1; ++y)
            for (int x = 1; x < kWidth - 1; ++x)
                for (int c = 0; c < 3; ++c) {
                    float least = in.at(x, y, c), most = least;
                    for (int i = 0; i < 9; ++i) {
                        least = std::min(least, in.at(x + i % 3 - 1, y + i / 3 - 1, c));
                        most = std::max(most, in.at(x + i % 3 - 1, y + i / 3 - 1, c));
                    }
                    ASSERT_GE(out.at(x, y, c), least) << method;
                    ASSERT_LE(out.at(x, y, c), most) << method;
                    changed |= out.at(x, y, c) != in.at(x, y, c);
                }
        EXPECT_TRUE(changed) << method;
    }
}

TEST(Sharpen, LeavesFlatLightFlatHoweverBright) {
    for (const float light : {0.0f, 0.18f, 1e4f}) {
        const Capture capture = make_capture({.background = {light, light, light}});
        for (const char* method : {"unsharp", "cas"}) {
            const Image out = sharpened(capture, R"("amount": 2, "method": ")" + std::string(method) + '"');
            for (const float value : {out.at(0, 0, 0), out.at(30, 17, 1), out.at(63, 35, 2)})
                EXPECT_EQ(value, light) << method;
        }
    }
}

}  // namespace
}  // namespace aftershade::test::sharpen
