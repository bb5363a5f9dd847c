// Samples where the noise was: without bias, within limits, as many as the wanted variance needs, and calm
// under light that changes.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "tests/backends.h"
#include "tests/scattering_checks.h"
#include "tests/wide_capture.h"

namespace aftershade::test::sss_adaptive {
namespace {

constexpr const char* kEffect = "sss_adaptive";
constexpr int kWidth = 48, kHeight = 32;
const std::vector<std::string> kTaps{"sss_adaptive.plan", "sss_adaptive.estimate", "sss_adaptive.history"};

/// Bumps, and a shadow's edge across them; the light times `factor`.
Capture shadow_edge(int frame, float factor = 1) {
    Capture capture = lit_plane(kWidth, kHeight, [&](int x, int y, int c) {
        return factor * (x + y / 4 < 24 ? 0.1f : 1.0f - 0.2f * float(c));
    });
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            capture.images.at("depth").at(x, y, 0) = float(1 + 0.02 * std::sin(x * 0.3) * std::cos(y * 0.2));
    capture.header.frame = frame;
    return capture;
}

std::string profile() {
    return burley_of_px(4, 2.5, 1.5, kWidth);
}

LookRunner runner(const std::string& more) {
    return LookRunner(scattering_step(kEffect, profile(), more), gpu::test_backend(), kTaps);
}

constexpr const char* kUnbiased =
    R"("min_samples": 1, "prefilter": false, "normalize": "none", "distant_share": 0, "guiding": false)";

struct PixelMoments {
    double sum = 0, squares = 0;
};

/// Of red over frames. The number of samples follows from frames before, so it may not pull the mean.
TEST(SssAdaptive, HasTheMeanOfTheExactSumWhateverDecidesTheNumberOfSamples) {
    const Image exact =
        scattered(scattering_step("sss_exact", profile(), R"("normalize": "none")"), shadow_edge(1));
    // difference swings between the limits: its few frames of one sample have long tails.
    for (const auto& [controller, frames] : {std::pair("ratio", 500), {"sqrt", 500}, {"difference", 5000}}) {
        LookRunner look = runner(std::string(kUnbiased) + R"(, "controller": ")" + controller + "\"");
        std::vector<PixelMoments> pixels(std::size_t(kWidth) * kHeight);
        double image_sum = 0, image_squares = 0, exact_mean = 0;
        for (int frame = 1; frame <= frames; ++frame) {
            const Image image = look.run(shadow_edge(frame)).images.at("irradiance");
            double mean = 0;
            for (std::size_t i = 0; i < pixels.size(); ++i) {
                const double value = image.at(int(i) % kWidth, int(i) / kWidth, 0);
                pixels[i].sum += value;
                pixels[i].squares += value * value;
                mean += value / double(pixels.size());
            }
            image_sum += mean;
            image_squares += mean * mean;
        }
        int within = 0;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const double mean = pixels[i].sum / frames;
            const double sigma =
                std::sqrt(std::max(pixels[i].squares / frames - mean * mean, 0.0) / (frames - 1));
            const double expected = exact.at(int(i) % kWidth, int(i) / kWidth, 0);
            within += std::abs(mean - expected) <= 3 * sigma + 1e-5;
            exact_mean += expected / double(pixels.size());
        }
        EXPECT_GE(within, int(0.995 * double(pixels.size()))) << controller;
        const double mean = image_sum / frames;
        EXPECT_LE(std::abs(mean - exact_mean),
                  3 * std::sqrt(std::max(image_squares / frames - mean * mean, 0.0) / (frames - 1)) + 1e-5)
            << controller;
    }
}

/// A variate changes what is followed, not what is drawn: in light that does not change not a bit.
TEST(SssAdaptive, DrawsTheSamePictureWithAnyControlVariateInSteadyLight) {
    std::vector<Image> last;
    for (const char* variate : {"none", "constant", "online"}) {
        LookRunner look = runner(std::string(kUnbiased) + R"(, "control_variate": ")" + variate + "\"");
        for (int frame = 1; frame < 20; ++frame) look.run(shadow_edge(frame));
        last.push_back(look.run(shadow_edge(20)).images.at("irradiance"));
    }
    EXPECT_LT(largest_change(last[0], last[1]), 1e-3);
    EXPECT_LT(largest_change(last[0], last[2]), 1e-3);
}

TEST(SssAdaptive, FallsToTheFewestSamplesInFlatLightAndRisesAtEdges) {
    LookRunner look =
        runner(R"("guiding": false, "prefilter": true, "target": "absolute", "target_variance": 0.0002,
        "max_samples": 128)");
    Image counts;
    for (int frame = 1; frame <= 40; ++frame)
        counts = look.run(shadow_edge(frame)).taps.at("sss_adaptive.history");
    double edge = 0, flat = 0;
    for (int y = 4; y < kHeight - 4; ++y) {
        edge += counts.at(24 - y / 4, y, 0) / (kHeight - 8);
        flat += counts.at(kWidth - 3, y, 0) / (kHeight - 8);
    }
    EXPECT_LT(flat, 10) << "min_samples is 8";
    EXPECT_GT(edge, 2 * flat);
}

/// Where the limits do not hold it back, the frame's variance is the wanted one.
TEST(SssAdaptive, MeetsTheWantedVariance) {
    const double target = 0.0005;
    LookRunner look = runner(
        R"("guiding": false, "prefilter": false, "normalize": "none", "distant_share": 0, "min_samples": 1,
        "max_samples": 512, "history_weight": 0.05, "control_variate": "none", "target": "absolute", "target_variance": 0.0005)");
    const int frames = 300, settle = 100;
    std::vector<PixelMoments> pixels(std::size_t(kWidth) * kHeight);
    std::vector<double> counts(pixels.size());
    for (int frame = 1; frame <= frames; ++frame) {
        const FrameResult result = look.run(shadow_edge(frame));
        if (frame <= settle) continue;
        const Image& light = result.images.at("irradiance");
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const int x = int(i) % kWidth, y = int(i) / kWidth;
            const double value =
                0.2126 * light.at(x, y, 0) + 0.7152 * light.at(x, y, 1) + 0.0722 * light.at(x, y, 2);
            pixels[i].sum += value;
            pixels[i].squares += value * value;
            counts[i] += result.taps.at("sss_adaptive.estimate").at(x, y, 3) / (frames - settle);
        }
    }
    double sum = 0;
    int unclamped = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (counts[i] < 3 || counts[i] > 250) continue;
        const double mean = pixels[i].sum / (frames - settle);
        sum += pixels[i].squares / (frames - settle) - mean * mean;
        ++unclamped;
    }
    ASSERT_GT(unclamped, 100);
    EXPECT_NEAR(sum / unclamped / target, 1, 0.25);
}

double mean_count(const FrameResult& result) {
    const Image& estimate = result.taps.at("sss_adaptive.estimate");
    double sum = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) sum += estimate.at(x, y, 3);
    return sum / (kWidth * kHeight);
}

/// Frames 8 to 15 are one epoch, in which a pixel goes on along one sequence; frames 8, 16, 24, ... are of
/// epochs of their own. Both are means of 8 frames of 4 samples.
TEST(SssAdaptive, ComesNearerByFramesOfOneEpochThanByAsManyOfDifferentOnes) {
    const Image exact = scattered(scattering_step("sss_exact", profile(), ""), shadow_edge(1));
    LookRunner look = runner(R"("guiding": false, "min_samples": 4, "max_samples": 4)");
    std::vector<double> together(std::size_t(kWidth) * kHeight), apart(together.size());
    for (int frame = 1; frame <= 64; ++frame) {
        const Image image = look.run(shadow_edge(frame)).images.at("irradiance");
        for (std::size_t i = 0; i < apart.size(); ++i) {
            const double error = double(image.at(int(i) % kWidth, int(i) / kWidth, 0)) -
                                 exact.at(int(i) % kWidth, int(i) / kWidth, 0);
            if (frame >= 8 && frame < 16) together[i] += error / 8;
            if (frame % 8 == 0) apart[i] += error / 8;
        }
    }
    const auto squares = [](const std::vector<double>& errors) {
        return std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0);
    };
    EXPECT_LT(squares(together), 0.6 * squares(apart));
}

/// Light that falls to a tenth and comes back: without a control variate all of that looks like noise.
TEST(SssAdaptive, StaysCalmUnderLightThatChangesByItsControlVariate) {
    std::vector<double> peaks;
    for (const char* variate : {"none", "constant", "online"}) {
        LookRunner look = runner(R"("guiding": false, "target": "absolute", "control_variate": ")" +
                                 std::string(variate) + "\"");
        double peak = 0;
        for (int frame = 1; frame <= 40; ++frame) {
            const FrameResult result = look.run(shadow_edge(frame, frame >= 20 && frame < 30 ? 0.1f : 1.0f));
            if (frame >= 20) peak = std::max(peak, mean_count(result));
        }
        peaks.push_back(peak);
    }
    EXPECT_LT(peaks[1], 0.6 * peaks[0]);
    EXPECT_LT(peaks[2], 0.6 * peaks[0]);
}

/// Light that falls to a tenth is a tenth in the very frame.
TEST(SssAdaptive, IsNotDraggedBehindByItsAverageWhereTheLightChanges) {
    for (const char* prefilter : {"true", "false"}) {
        LookRunner look = runner(R"("guiding_weight": 0.05, "prefilter": )" + std::string(prefilter));
        Image before, after;
        for (int frame = 1; frame <= 20; ++frame)
            before = look.run(shadow_edge(frame)).images.at("irradiance");
        after = look.run(shadow_edge(21, 0.1f)).images.at("irradiance");
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sum_of(after, c) / sum_of(before, c), 0.1, 0.002) << prefilter;
    }
}

double rmse(const Image& a, const Image& b, double times) {
    double sum = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) sum += std::pow(a.at(x, y, 0) - times * b.at(x, y, 0), 2);
    return std::sqrt(sum / (kWidth * kHeight));
}

/// The same light, a tenth as bright: the average over frames is carried along, and stays smooth.
TEST(SssAdaptive, TakesItsAverageAlongWhereLightIsOnlyDarker) {
    const Image exact = scattered(scattering_step("sss_exact", profile(), ""), shadow_edge(1));
    LookRunner look(scattering_step(kEffect, profile(), R"("guiding_weight": 0.05, "prefilter": true)"),
                    gpu::test_backend(), {"sss_adaptive.estimate", "sss_adaptive.guided"});
    for (int frame = 1; frame <= 20; ++frame) look.run(shadow_edge(frame));
    const FrameResult result = look.run(shadow_edge(21, 0.1f));
    const double guided = rmse(result.images.at("irradiance"), exact, 0.1),
                 alone = rmse(result.taps.at("sss_adaptive.estimate"), exact, 0.1);
    EXPECT_LT(guided, 0.5 * alone);
    EXPECT_EQ(result.taps.at("sss_adaptive.guided").at(10, 10, 3), 21 + 9) << "frames";
}

/// shadow_edge() as a camera sees it whose samples lie elsewhere in the pixels in each frame, as taa wants
/// it: Halton.
Capture jittered(int frame) {
    const auto halton = [](int index, int base) {
        double value = 0, part = 1;
        for (; index > 0; index /= base) value += index % base * (part /= base);
        return value - 0.5;
    };
    const double dx = halton(frame % 16 + 1, 2), dy = halton(frame % 16 + 1, 3);
    Capture capture = lit_plane(kWidth, kHeight, [&](int x, int y, int c) {
        return x + dx + (y + dy) / 4 < 24 ? 0.1f : 1.0f - 0.2f * float(c);
    });
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            capture.images.at("depth").at(x, y, 0) =
                float(1 + 0.02 * std::sin((x + dx) * 0.3) * std::cos((y + dy) * 0.2));
    capture.header.frame = frame;
    return capture;
}

TEST(SssAdaptive, SettlesUnderJitterWithEveryControlVariate) {
    for (const char* variate : {"none", "constant", "online"}) {
        LookRunner look = runner(
            R"("guiding": false, "target": "absolute", "target_variance": 0.001, "control_variate": ")" +
            std::string(variate) + "\"");
        std::vector<double> means;
        for (int frame = 1; frame <= 96; ++frame) {
            const double mean = mean_count(look.run(jittered(frame)));
            if (frame > 32) means.push_back(mean);
        }
        const auto [least, most] = std::minmax_element(means.begin(), means.end());
        EXPECT_LT(*most / *least, 1.1) << variate << ": pumps";
        const auto half = means.begin() + 32;
        const double early = std::accumulate(means.begin(), half, 0.0) / 32,
                     late = std::accumulate(half, means.end(), 0.0) / 32;
        EXPECT_NEAR(late / early, 1, 0.03) << variate << ": grows";
        EXPECT_LT(late, 32) << variate << ": stays at the limit";
    }
}

TEST(SssAdaptive, TakesNoMoreThanTheMostAndBeginsInTheMiddle) {
    LookRunner look = runner(R"("min_samples": 4, "max_samples": 24, "target_variance": 1e-8)");
    for (int frame = 1; frame <= 5; ++frame) {
        const FrameResult result = look.run(shadow_edge(frame));
        const Image& estimate = result.taps.at("sss_adaptive.estimate");
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                ASSERT_GE(estimate.at(x, y, 3), frame == 1 ? 14 : 4);
                ASSERT_LE(estimate.at(x, y, 3), frame == 1 ? 14 : 24);
            }
    }
}

/// A strip of another object moves by 3 px a frame: what it uncovers has no history, and none that is another
/// object's.
TEST(SssAdaptive, BeginsAnewWhereAnotherObjectWas) {
    LookRunner look = runner(R"("guiding_weight": 0.1)");
    for (int frame = 1; frame <= 8; ++frame) {
        Capture capture = shadow_edge(frame);
        const int left = 3 * frame;
        for (int y = 0; y < kHeight; ++y)
            for (int x = left; x < left + 10; ++x) {
                capture.images.at("object_id").uint_at(x, y, 0) = 2;
                capture.images.at("velocity").at(x, y, 0) = 3;
                for (int c = 0; c < 3; ++c) capture.images.at("irradiance").at(x, y, c) = 20;
            }
        const FrameResult result = look.run(capture);
        if (frame == 1) continue;
        const Image& plan = result.taps.at("sss_adaptive.plan");
        const Image& light = result.images.at("irradiance");
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const bool uncovered = x >= left - 3 && x < left;
                const bool strip = x >= left && x < left + 10;
                ASSERT_EQ(plan.at(x, y, 1), uncovered ? 0 : 1) << frame << " " << x << " " << y;
                ASSERT_LE(plan.at(x, y, 0), 64);
                const double expected = strip ? 20 : 0.55;
                ASSERT_NEAR(light.at(x, y, 0), expected, strip ? 0.05 : 0.55) << "no trail";
            }
    }
}

/// A wall that leads away: where less than 5 % of the light leaves a pixel it is 8.129 d wide from its middle
/// to its edge.
TEST(SssAdaptive, KeepsLightAsItIsWhereItDoesNotLeaveItsPixel) {
    Capture capture = shadow_edge(1);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) capture.images.at("depth").at(x, y, 0) = 1 + float(x);
    const std::string narrow = burley_of_px(2, 1, 0.5, kWidth);
    const Image plan =
        LookRunner(scattering_step(kEffect, narrow, R"("distant_fade": false)"), gpu::test_backend(), kTaps)
            .run(capture)
            .taps.at("sss_adaptive.plan");
    // Half a pixel is 0.5 * depth px of the plane 1 m away, d is 2 px there: 8.129 * 2 / 0.5 m.
    const double depth_m = 8.129 * 2 / 0.5;
    for (int x = 0; x < kWidth; ++x) {
        ASSERT_EQ(plan.at(x, 5, 2), 1 + x < depth_m ? 1 : 0) << x;
        ASSERT_EQ(plan.at(x, 5, 0) > 0, 1 + x < depth_m) << x;
    }
}

/// On both sides of the switch's depth: what changes is at most a twentieth of the contrast around.
TEST(SssAdaptive, JumpsByNoMoreThanTheShareThatItKeepsWhereItSwitches) {
    const auto at_depth = [&](double depth_m) {
        Capture capture =
            lit_plane(kWidth, kHeight, [](int x, int, int) { return x % 2 == 0 ? 1.0f : 0.2f; });
        for (float& value : capture.images.at("depth").floats()) value = float(depth_m);
        const std::string narrow = burley_of_px(2, 1, 0.5, kWidth);
        const std::string many =
            R"("distant_fade": false, "guiding": false, "min_samples": 4096, "max_samples": 4096)";
        return scattered(scattering_step(kEffect, narrow, many), capture);
    };
    const double switch_m = 8.129 * 2 / 0.5;
    const Image nearer = at_depth(0.998 * switch_m), farther = at_depth(1.002 * switch_m);
    double most = 0;
    for (int y = 4; y < kHeight - 4; ++y)
        for (int x = 4; x < kWidth - 4; ++x) {
            ASSERT_EQ(farther.at(x, y, 0), x % 2 == 0 ? 1.0f : 0.2f) << "is kept";
            most = std::max(most, std::abs(double(nearer.at(x, y, 0)) - farther.at(x, y, 0)));
        }
    EXPECT_LE(most, 0.05 * (1.0 - 0.2));
    EXPECT_GT(most, 0.01) << "some light does leave";
}

TEST(SssAdaptive, LetsNothingCrossSilhouettes) {
    expect_nothing_crosses_silhouettes(kEffect, R"("prefilter": false)");
}
TEST(SssAdaptive, LeavesTheBitsOfWhatDoesNotScatter) {
    expect_the_rest_keeps_its_bits(kEffect, "");
}
TEST(SssAdaptive, LeavesLightThatIsNoNumberAlone) {
    expect_no_number_stays_alone(kEffect, R"("distant_share": 0)");
}
TEST(SssAdaptive, ChangesTheHeadOfSuzanneAlone) {
    expect_the_head_of_suzanne_alone_changes(kEffect, "");
}

TEST(SssAdaptive, FollowsTheSameLuminanceOfCapturesInWiderPrimaries) {
    const Capture capture = lit_plane(kWidth, kHeight, [](int, int, int c) { return c == 0 ? 1 : 0.1f; });
    const std::string more =
        R"("guiding": false, "prefilter": false, "control_variate": "none", "target": "absolute")";
    for (const char* space : {"rec709", "rec2020", "acescg"}) {
        const FrameResult result = runner(more).run(in_space(capture, space));
        const double luminance = result.taps.at("sss_adaptive.history").at(kWidth / 2, kHeight / 2, 2);
        EXPECT_NEAR(luminance, 0.2126 + 0.1 * (0.7152 + 0.0722), 1e-4) << space;
    }
}

}  // namespace
}  // namespace aftershade::test::sss_adaptive
