// Light, shadows and cameras that move: the average over frames follows them, from the first frame on, and
// taa after it does, too. Held to many samples of sss_burley.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/backends.h"
#include "tests/scattering_checks.h"

namespace aftershade::test::sss_adaptive_moving {
namespace {

constexpr int kWidth = 120, kHeight = 40;

/// Light at a place and a time in frames, of a channel.
using MovingLight = std::function<double(double x, double y, int c, int frame)>;

double bar(double x, double middle) {
    return std::abs(x - middle) < 7 ? 0.1 : 1;
}

/// A bar's shadow that goes to and fro between 20 and 110 px.
MovingLight bar_at(double px_per_frame) {
    return [=](double x, double y, int c, int frame) {
        const double way = std::fmod(px_per_frame * frame, 180);
        return bar(x + y / 4, 20 + (way < 90 ? way : 180 - way)) * (1 - 0.2 * c);
    };
}

Capture captured(const MovingLight& light, int frame, double pan_px = 0) {
    const double seen_from = pan_px * frame;
    Capture capture = lit_plane(
        kWidth, kHeight, [&](int x, int y, int c) { return float(light(x + seen_from, y, c, frame)); });
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            capture.images.at("velocity").at(x, y, 0) = float(-pan_px);
            for (int c = 0; c < 3; ++c) {
                capture.images.at("albedo").at(x, y, c) = 0.5f;
                capture.images.at("color").at(x, y, c) = 0.5f * capture.images.at("irradiance").at(x, y, c);
            }
        }
    capture.header.frame = frame;
    return capture;
}

struct Motion {
    std::string name;
    MovingLight light;
    double pan_px = 0;
};

const std::vector<Motion>& motions() {
    static const std::vector<Motion> all{
        {"a shadow at 0.4 px a frame", bar_at(0.4)},
        {"a shadow at 1.6 px a frame", bar_at(1.6)},
        {"a shadow at 6.5 px a frame", bar_at(6.5)},
        {"a shadow at 26 px a frame", bar_at(26)},
        {"light that changes its colour",
         [](double x, double y, int c, int frame) {
             return bar(x + y / 4, 50) * (0.6 + 0.4 * std::sin(0.5 * frame + 2 * c));
         }},
        {"light that fades by 1 % a frame",
         [](double x, double y, int c, int frame) {
             return bar(x + y / 4, 50) * (1 - 0.2 * c) * std::pow(0.99, frame);
         }},
        {"a camera that pans under fixed light",
         [](double x, double y, int c, int) { return bar(x + y / 4, 70) * (1 - 0.2 * c); }, 1.3},
    };
    return all;
}

std::string profile() {
    return burley_of_px(3, 2, 1, kWidth);
}

std::string step(const std::string& effect, const std::string& more = "") {
    return scattering_step(effect, profile(), more);
}

double luminance(const Image& image, int x, int y) {
    return 0.2126 * image.at(x, y, 0) + 0.7152 * image.at(x, y, 1) + 0.0722 * image.at(x, y, 2);
}

/// Root mean square of luminance, over what the camera sees for more than a frame.
double error(const Image& a, const Image& b) {
    double sum = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth - 4; ++x) sum += std::pow(luminance(a, x, y) - luminance(b, x, y), 2);
    return std::sqrt(sum / (kHeight * (kWidth - 4)));
}

double decibels(double better, double worse) {
    return 20 * std::log10(worse / better);
}

Image reference_of(const Motion& motion, int frame) {
    static std::map<std::pair<std::string, int>, Image> made;
    static LookRunner look(step("sss_burley", R"("samples": 2048)"), gpu::test_backend());
    const auto [at, fresh] = made.try_emplace({motion.name, frame});
    if (fresh) at->second = look.run(captured(motion.light, frame, motion.pan_px)).images.at("irradiance");
    return at->second;
}

double mean_count(const FrameResult& result) {
    const Image& samples = result.taps.at("sss_adaptive.samples");
    double sum = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) sum += samples.at(x, y, 0);
    return sum / (kWidth * kHeight);
}

/// Without guiding a shadow that jumps looks like noise, and takes several times the samples: such frames are
/// not compared with it.
TEST(SssAdaptiveMoving, IsNearerThanAsManyFixedSamplesAndThanEachFrameAlone) {
    for (const Motion& motion : motions()) {
        SCOPED_TRACE(motion.name);
        LookRunner guided(step("sss_adaptive"), gpu::test_backend(), {"sss_adaptive.samples"}),
            alone(step("sss_adaptive", R"("guiding": false)"), gpu::test_backend(), {"sss_adaptive.samples"});
        for (int frame = 1; frame <= 13; ++frame) {
            const Capture capture = captured(motion.light, frame, motion.pan_px);
            const FrameResult result = guided.run(capture), estimate = alone.run(capture);
            if (frame < 9) continue;
            const double count = mean_count(result);
            const Image fixed =
                scattered(step("sss_burley", "\"samples\": " + std::to_string(std::lround(count))), capture);
            const Image reference = reference_of(motion, frame);
            const double own = error(result.images.at("irradiance"), reference);
            EXPECT_GT(decibels(own, error(fixed, reference)), 1.5)
                << "frame " << frame << ", samples " << count;
            if (mean_count(estimate) > 1.5 * count) continue;
            EXPECT_GT(decibels(own, error(estimate.images.at("irradiance"), reference)), 0)
                << "frame " << frame;
        }
    }
}

TEST(SssAdaptiveMoving, IsNoWorseThanTheTwoBlursInItsFirstFrameAndMuchBetterInItsSixteenth) {
    const Motion still{"at rest",
                       [](double x, double y, int c, int) { return bar(x + y / 4, 50) * (1 - 0.2 * c); }};
    LookRunner look(step("sss_adaptive"), gpu::test_backend());
    const Image reference = reference_of(still, 1),
                blurred = scattered(step("sss_separable"), captured(still.light, 1));
    for (int frame = 1; frame <= 16; ++frame) {
        const Image image = look.run(captured(still.light, frame)).images.at("irradiance");
        const double gained = decibels(error(image, reference), error(blurred, reference));
        if (frame == 1) {
            EXPECT_GE(gained, 0);
        } else if (frame == 16) {
            EXPECT_GE(gained, 3);
        }
    }
}

/// Between the means of neighbouring columns, so that noise does not count.
double largest_step(const Image& image) {
    double most = 0;
    for (int x = 1; x < kWidth; ++x)
        most = std::max(most, std::abs(row_mean(image, x, 0, kHeight) - row_mean(image, x - 1, 0, kHeight)));
    return most;
}

TEST(SssAdaptiveMoving, HasNoBandsWhereSmoothLightMoves) {
    const Motion wave{"a wave", [](double x, double, int c, int frame) {
                          return (0.55 + 0.45 * std::sin((x - 2 * frame) / 6)) * (1 - 0.2 * c);
                      }};
    LookRunner look(step("sss_adaptive"), gpu::test_backend());
    for (int frame = 1; frame <= 13; ++frame) {
        const Image image = look.run(captured(wave.light, frame)).images.at("irradiance");
        if (frame < 9) continue;
        EXPECT_LT(largest_step(image), 1.3 * largest_step(reference_of(wave, frame))) << "frame " << frame;
    }
}

TEST(SssAdaptiveMoving, TakesTheSameSamplesHoweverBrightTheCaptureIs) {
    std::vector<double> counts;
    for (const double bright : {1.0, 1.0 / 16, 16.0}) {
        LookRunner look(step("sss_adaptive"), gpu::test_backend(), {"sss_adaptive.samples"});
        double count = 0;
        for (int frame = 1; frame <= 20; ++frame) {
            const MovingLight light = bar_at(1.6);
            const Capture capture = captured(
                [&](double x, double y, int c, int at) { return bright * light(x, y, c, at); }, frame);
            count += mean_count(look.run(capture));
        }
        counts.push_back(count);
    }
    EXPECT_NEAR(counts[1] / counts[0], 1, 0.02);
    EXPECT_NEAR(counts[2] / counts[0], 1, 0.02);
}

std::string chain(const std::string& effect, const std::string& more, const std::string& after) {
    return R"({ "aftershade": 1, "steps": [ { "effect": ")" + effect +
           R"(", "params": { "scattering_profile": )" + profile() + more +
           R"( } }, { "effect": "sss_combine" })" + after + " ] }";
}

/// The albedo of the captures.
void halve(Image& image) {
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (int c = 0; c < 3; ++c) image.at(x, y, c) *= 0.5f;
}

TEST(SssAdaptiveMoving, LosesLittleOfItToTaaInAnyFrame) {
    for (const Motion& motion : motions()) {
        SCOPED_TRACE(motion.name);
        LookRunner alone(chain("sss_adaptive", "", ""), gpu::test_backend()),
            followed(chain("sss_adaptive", "", R"(, { "effect": "taa" })"), gpu::test_backend());
        for (int frame = 1; frame <= 13; ++frame) {
            const Capture capture = captured(motion.light, frame, motion.pan_px);
            const Image step_alone = alone.run(capture).images.at("color"),
                        with_taa = followed.run(capture).images.at("color");
            if (frame < 9) continue;
            Image reference = reference_of(motion, frame);
            halve(reference);
            EXPECT_LT(decibels(error(step_alone, reference), error(with_taa, reference)), 0.3)
                << "frame " << frame;
        }
    }
}

/// The step's own average gets better from frame to frame, and what taa keeps is older. Where taa weighs all
/// frames alike, it loses 2.6 dB; where history counts while there are neither motion nor jitter, 1.4 dB.
TEST(SssAdaptiveMoving, LosesLittleOfItsFirstFramesAtRestToTaaAndGainsByItThen) {
    const Motion still{"at rest",
                       [](double x, double y, int c, int) { return bar(x + y / 4, 50) * (1 - 0.2 * c); }};
    LookRunner alone(chain("sss_adaptive", "", ""), gpu::test_backend()),
        followed(chain("sss_adaptive", "", R"(, { "effect": "taa" })"), gpu::test_backend());
    Image reference = reference_of(still, 1);
    halve(reference);
    for (int frame = 1; frame <= 20; ++frame) {
        const Capture capture = captured(still.light, frame);
        const double own = error(alone.run(capture).images.at("color"), reference),
                     with_taa = error(followed.run(capture).images.at("color"), reference);
        EXPECT_LT(decibels(own, with_taa), frame < 16 ? 0.3 : 0) << "frame " << frame;
    }
}

/// Beside the brightest part of skin scattered light hardly changes while a highlight goes over it.
TEST(SssAdaptiveMoving, LosesLittleOfAHighlightThatGoesWithTheLightToTaa) {
    const auto middle = [](int frame) { return 30 + 2.0 * frame; };
    const Motion lamp{"a lamp that goes by", [&](double x, double, int c, int frame) {
                          return (0.1 + std::exp(-std::pow((x - middle(frame)) / 25, 2))) * (1 - 0.2 * c);
                      }};
    const auto highlight = [&](int x, int frame) {
        return 0.1f * float(std::exp(-std::pow((x - middle(frame)) / 5, 2)));
    };
    LookRunner alone(chain("sss_adaptive", "", ""), gpu::test_backend()),
        followed(chain("sss_adaptive", "", R"(, { "effect": "taa" })"), gpu::test_backend());
    double before = 0, after = 0;
    for (int frame = 1; frame <= 13; ++frame) {
        Capture capture = captured(lamp.light, frame);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                for (int c = 0; c < 3; ++c) capture.images.at("color").at(x, y, c) += highlight(x, frame);
        const Image step_alone = alone.run(capture).images.at("color"),
                    with_taa = followed.run(capture).images.at("color");
        if (frame < 9) continue;
        Image reference = reference_of(lamp, frame);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                for (int c = 0; c < 3; ++c)
                    reference.at(x, y, c) = 0.5f * reference.at(x, y, c) + highlight(x, frame);
        before += std::pow(error(step_alone, reference), 2);
        after += std::pow(error(with_taa, reference), 2);
    }
    EXPECT_LT(10 * std::log10(after / before), 0.3) << 10 * std::log10(after / before);
}

/// Frames reuse what nothing changed; whatever changes, the blurs are those of a frame on its own.
TEST(SssAdaptiveMoving, HasTheBlursOfEachFrameWhateverChangedSinceTheOneBefore) {
    LookRunner look(step("sss_adaptive"), gpu::test_backend(), {"sss_adaptive.blurred"});
    for (int frame = 1; frame <= 10; ++frame) {
        Capture capture = captured(bar_at(0), 1);
        capture.header.frame = frame;
        // At rest, a pixel in a corner, one in the middle, at rest, depth, the lens, an object, at rest, two
        // pixels in turn.
        if (frame == 2) capture.images.at("irradiance").at(1, 1, 0) = 5;
        if (frame == 3 || frame == 4) capture.images.at("irradiance").at(30, 16, 1) = 5;
        if (frame == 5) capture.images.at("depth").at(40, 20, 0) = 0.9f;
        if (frame == 6) capture.header.camera.set("focal_length", 70);
        if (frame >= 7) capture.images.at("object_id").uint_at(20, 8, 0) = 7;
        if (frame >= 9) capture.images.at("irradiance").at(frame == 9 ? 33 : 35, 20, 2) = 4;
        const Image blurred = look.run(capture).taps.at("sss_adaptive.blurred"),
                    fresh = scattered(step("sss_separable", R"("samples": 25)"), capture);
        int off = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                for (int c = 0; c < 3; ++c) off += blurred.at(x, y, c) != fresh.at(x, y, c);
        EXPECT_EQ(off, 0) << "frame " << frame;
    }
}

}  // namespace
}  // namespace aftershade::test::sss_adaptive_moving
