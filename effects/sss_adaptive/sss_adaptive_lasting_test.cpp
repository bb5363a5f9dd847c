// What an average over frames must not keep: a highlight that has gone, a measure of darkness, a fraction of
// a pixel, a value that is no number.
#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "tests/backends.h"
#include "tests/scattering_checks.h"

namespace aftershade::test::sss_adaptive_lasting {
namespace {

constexpr int kWidth = 96, kHeight = 40;
const std::string kSamples = "sss_adaptive.samples";

Capture at_frame(int frame, const Light& light, double pan_px = 0) {
    Capture capture = lit_plane(kWidth, kHeight, light);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) capture.images.at("velocity").at(x, y, 0) = float(-pan_px);
    capture.header.frame = frame;
    return capture;
}

std::string step(const std::string& effect, const std::string& more = "", double d_px = 3) {
    return scattering_step(effect, burley_of_px(d_px, d_px * 2 / 3, d_px / 3, kWidth), more);
}

/// Root mean square of all channels, of columns up to the last 8, which a camera that pans has seen for long.
double error(const Image& a, const Image& b) {
    double sum = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth - 8; ++x)
            for (int c = 0; c < 3; ++c) sum += std::pow(double(a.at(x, y, c)) - b.at(x, y, c), 2);
    return std::sqrt(sum);
}

double mean(const Image& image, int from_x) {
    double sum = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = from_x; x < kWidth; ++x) sum += image.at(x, y, 0);
    return sum / (kHeight * (kWidth - from_x));
}

float bars(double x, double y, int c) {
    return float((std::fmod(x + y / 4, 40) < 14 ? 0.05 : 0.5) * (1 - 0.2 * c));
}

TEST(SssAdaptiveLasting, ForgetsAHighlightWithinFramesOfItsEnd) {
    LookRunner guided(step("sss_adaptive"), gpu::test_backend()),
        alone(step("sss_adaptive", R"("guiding": false)"), gpu::test_backend());
    Image reference;
    for (int frame = 1; frame <= 14; ++frame) {
        const Capture capture = at_frame(frame, [&](int x, int y, int c) {
            return frame == 9 && x == 48 && y == 20 ? 1000.0f : bars(x, y, c);
        });
        const Image average = guided.run(capture).images.at("irradiance"),
                    each = alone.run(capture).images.at("irradiance");
        if (frame < 12) continue;
        if (reference.empty()) reference = scattered(step("sss_burley", R"("samples": 2048)"), capture);
        EXPECT_LT(error(average, reference), error(each, reference)) << "frame " << frame;
    }
}

TEST(SssAdaptiveLasting, KeepsFineShadowsUnderACameraThatPansByHalfAPixel) {
    const auto stripes = [](double x, double y, int c) {
        return float((std::abs(std::fmod(x + 0.4 * y, 10) - 5) < 1 ? 0.05 : 1) * (1 - 0.2 * c));
    };
    for (const double pan_px : {0.45, 1.5}) {
        LookRunner guided(step("sss_adaptive"), gpu::test_backend(), {kSamples});
        for (int frame = 1; frame <= 14; ++frame) {
            const Capture capture = at_frame(
                frame, [&](int x, int y, int c) { return stripes(x + pan_px * frame, y, c); }, pan_px);
            const FrameResult result = guided.run(capture);
            if (frame < 12) continue;
            const auto burley = [&](long samples) {
                return scattered(step("sss_burley", fmt::format(R"("samples": {})", samples)), capture);
            };
            const Image reference = burley(2048),
                        fixed = burley(std::lround(mean(result.taps.at(kSamples), 0)));
            EXPECT_LT(error(result.images.at("irradiance"), reference), 0.9 * error(fixed, reference))
                << pan_px << " px, frame " << frame;
        }
    }
}

/// The blurs miss much of shadows as thin as this, and what they miss moves with the shadows. An average that
/// weighs frames by their age alone has 1.2 times the error.
TEST(SssAdaptiveLasting, KeepsUpWithThinShadowsThatMove) {
    LookRunner guided(step("sss_adaptive"), gpu::test_backend(), {kSamples});
    for (int frame = 1; frame <= 14; ++frame) {
        const Capture capture = at_frame(frame, [&](int x, int y, int c) {
            const double from_middle = std::fmod(x + 0.25 * y + 140 - 1.6 * frame, 14) - 7;
            return float((std::abs(from_middle) < 3 ? 0.05 : 0.9) * (1 - 0.2 * c));
        });
        const FrameResult result = guided.run(capture);
        if (frame < 9) continue;
        const auto burley = [&](long samples) {
            return scattered(step("sss_burley", fmt::format(R"("samples": {})", samples)), capture);
        };
        const Image reference = burley(2048), fixed = burley(std::lround(mean(result.taps.at(kSamples), 0)));
        EXPECT_LT(error(result.images.at("irradiance"), reference), error(fixed, reference))
            << "frame " << frame;
    }
}

TEST(SssAdaptiveLasting, TakesFewSamplesAgainOnceItIsNoLongerDarkAround) {
    const auto count = [](float dark) {
        LookRunner look(step("sss_adaptive", "", 12), gpu::test_backend(), {kSamples});
        double samples = 0;
        for (int frame = 1; frame <= 48; ++frame)
            samples = mean(look.run(at_frame(frame,
                                             [&](int x, int, int) {
                                                 return frame > 8 ? 0.9f : x < 2 ? 1.0f : dark;
                                             }))
                               .taps.at(kSamples),
                           kWidth / 2);
        return samples;
    };
    EXPECT_LT(count(0), 1.1 * count(0.3f));
}

/// Beside its horizon a plane's facets are up to 1000 times as long as they look.
TEST(SssAdaptiveLasting, HasNumbersUpToTheHorizonOfAPlane) {
    for (int i = 0; i < 24; ++i) {
        const double horizon_px = 89.5 + 0.025 * i;
        LookRunner look(step("sss_adaptive", "", 30), gpu::test_backend(), {"sss_adaptive.guided"});
        Capture capture = at_frame(1, [](int, int, int) { return 1.0f; });
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const double nearness = 1 - (x + 0.5) / horizon_px;
                const bool is_there = nearness > 1e-5;
                capture.images.at("depth").at(x, y, 0) =
                    is_there ? float(1 / nearness) : std::numeric_limits<float>::infinity();
                capture.images.at("object_id").uint_at(x, y, 0) = is_there ? 1 : 0;
            }
        const FrameResult result = look.run(capture);
        for (const float value : result.taps.at("sss_adaptive.guided").floats())
            ASSERT_TRUE(std::isfinite(value)) << "horizon at " << horizon_px;
    }
}

}  // namespace
}  // namespace aftershade::test::sss_adaptive_lasting
