// Samples where the light is lively, two blurs where it is calm: each pixel has the bits of whoever does it.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/scattering_checks.h"

namespace aftershade::test::sss_adaptive_hybrid {
namespace {

constexpr const char* kEffect = "sss_adaptive";
constexpr int kWidth = 96, kHeight = 64;

/// A wall with waves: dark on the left, lit on the right; a ball of another object before it.
Capture wall(int frame) {
    Capture capture = lit_plane(
        kWidth, kHeight, [](int x, int y, int c) { return x + y / 4 < 24 ? 0.1f : 1.0f - 0.2f * float(c); });
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            capture.images.at("depth").at(x, y, 0) = float(1 + 0.02 * std::sin(x * 0.3) * std::cos(y * 0.2));
            const double across = (x - 74) / 12.0, down = (y - 40) / 12.0,
                         square = across * across + down * down;
            if (square > 1) continue;
            capture.images.at("depth").at(x, y, 0) = float(0.9 - 0.06 * std::sqrt(1 - square));
            capture.images.at("object_id").uint_at(x, y, 0) = 2;
        }
    capture.header.frame = frame;
    return capture;
}

std::string profile() {
    return burley_of_px(3, 2, 1, kWidth);
}

LookRunner runner(const std::string& more, std::vector<std::string> taps = {}) {
    return LookRunner(scattering_step(kEffect, profile(), more), gpu::Backend::software, std::move(taps));
}

int pixels_that_differ(const Image& a, const Image& b) {
    int count = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) count += !same_bits_at(a, b, x, y);
    return count;
}

TEST(SssAdaptiveHybrid, HasTheBitsOfSamplesAloneWhereNoLightIsCalm) {
    for (const char* more :
         {R"("prefilter": true, "guiding": true)", R"("prefilter": false, "guiding": true)",
          R"("prefilter": true, "guiding": false, "control_variate": "online")",
          R"("prefilter": false, "guiding": false)"}) {
        LookRunner off = runner(more),
                   all = runner(std::string(more) + R"(, "hybrid": "auto", "calm_range": 0)");
        for (int frame = 1; frame <= 4; ++frame) {
            const FrameResult alone = off.run(wall(frame)), hybrid = all.run(wall(frame));
            EXPECT_EQ(pixels_that_differ(alone.images.at("irradiance"), hybrid.images.at("irradiance")), 0)
                << more << ", frame " << frame;
        }
    }
}

TEST(SssAdaptiveHybrid, HasTheBitsOfTheTwoBlursWhereAllIsBlurred) {
    const Image blurred = scattered(scattering_step("sss_separable", profile(), R"("samples": 17)"), wall(1));
    for (const char* who :
         {R"("hybrid": "separable")", R"("hybrid": "separable", "guiding": false)",
          R"("hybrid": "auto", "sampled_ids": [9])", R"("hybrid": "auto", "calm_range": 1)"}) {
        const std::string more = std::string(who) + R"(, "blur_samples": 17, "distant_share": 0)";
        const Image hybrid = scattered(scattering_step(kEffect, profile(), more), wall(1));
        EXPECT_EQ(pixels_that_differ(hybrid, blurred), 0) << who;
    }
}

/// What the tiles' lists draw is what their classes say, and the classes are those of a count over all pixels
/// here.
TEST(SssAdaptiveHybrid, DrawsTheTilesThatItsClassesSay) {
    const FrameResult result =
        runner(R"("hybrid": "auto", "guiding": false)",
               {"sss_adaptive.tile_class", "sss_adaptive.tile_range", "sss_adaptive.sampled",
                "sss_adaptive.estimate", "sss_adaptive.blurred", "sss_adaptive.plan"})
            .run(wall(1));
    const Image &classes = result.taps.at("sss_adaptive.tile_class"),
                &sampled = result.taps.at("sss_adaptive.sampled"),
                &estimate = result.taps.at("sss_adaptive.estimate"),
                &blurred = result.taps.at("sss_adaptive.blurred"),
                &plan = result.taps.at("sss_adaptive.plan");
    ASSERT_EQ(classes.width(), kWidth / 8);
    int sampled_tiles = 0, blurred_tiles = 0, both = 0;
    for (int ty = 0; ty < kHeight / 8; ++ty)
        for (int tx = 0; tx < kWidth / 8; ++tx) {
            const bool is_sampled = classes.at(tx, ty, 0) > 0, is_blurred = classes.at(tx, ty, 1) > 0;
            sampled_tiles += is_sampled;
            blurred_tiles += is_blurred;
            both += is_sampled && is_blurred;
            for (int y = 8 * ty; y < 8 * ty + 8; ++y)
                for (int x = 8 * tx; x < 8 * tx + 8; ++x) {
                    const float share = sampled.at(x, y, 0);
                    EXPECT_TRUE(share == 0 || is_sampled) << x << " " << y;
                    EXPECT_TRUE(share == 1 || is_blurred) << x << " " << y;
                    EXPECT_EQ(blurred.at(x, y, 3), is_blurred ? 1 : 0);
                    EXPECT_EQ(estimate.at(x, y, 3), share > 0 ? plan.at(x, y, 0) : 0);
                    EXPECT_EQ(plan.at(x, y, 0) > 0, share > 0);
                }
        }
    EXPECT_GT(sampled_tiles, 8);
    EXPECT_GT(blurred_tiles, 8);
    EXPECT_GT(both, 0) << "mixed between calm_range and twice that";
}

/// The range of each tile as its doc says, counted here from the pixels: 5 d are 15 px, so two tiles on.
TEST(SssAdaptiveHybrid, TakesTheRangeOfTheLightWithinFiveD) {
    const Capture capture = wall(1);
    const Image ranges = runner(R"("hybrid": "auto")", {"sss_adaptive.tile_range"})
                             .run(capture)
                             .taps.at("sss_adaptive.tile_range");
    const Image& light = capture.images.at("irradiance");
    for (int ty = 0; ty < kHeight / 8; ++ty)
        for (int tx = 0; tx < kWidth / 8; ++tx) {
            double least = 1e30, most = 0;
            // The ball is nearer than the wall: 5 d are more than 16 px.
            bool ball = false;
            for (int y = 8 * ty; y < 8 * ty + 8; ++y)
                for (int x = 8 * tx; x < 8 * tx + 8; ++x)
                    ball |= capture.images.at("object_id").uint_at(x, y, 0) == 2;
            const int reach = ball ? 3 : 2;
            for (int y = std::max(0, 8 * (ty - reach)); y < std::min(kHeight, 8 * (ty + reach + 1)); ++y)
                for (int x = std::max(0, 8 * (tx - reach)); x < std::min(kWidth, 8 * (tx + reach + 1)); ++x) {
                    const double own =
                        0.2126 * light.at(x, y, 0) + 0.7152 * light.at(x, y, 1) + 0.0722 * light.at(x, y, 2);
                    least = std::min(least, own);
                    most = std::max(most, own);
                }
            EXPECT_NEAR(ranges.at(tx, ty, 0), (most - least) / most, 1e-5) << tx << " " << ty;
        }
}

/// Against the sum over all pixels, averaged over many frames: near to samples alone, better than blurs
/// alone.
TEST(SssAdaptiveHybrid, LiesBetweenSamplesAndBlursAndHasNoSeams) {
    const Image exact = scattered(scattering_step("sss_exact", profile(), R"("normalize": "all")"), wall(1));
    const std::string calm =
        R"("prefilter": false, "normalize": "all", "target_variance": 0.0001, "guiding_weight": 0.01)";
    std::vector<double> errors;
    Image last;
    for (const char* hybrid : {"off", "auto", "separable"}) {
        std::vector<std::string> taps;
        if (std::string(hybrid) != "off") taps = {"sss_adaptive.sampled"};
        LookRunner look = runner(calm + R"(, "hybrid": ")" + hybrid + "\"", taps);
        FrameResult result;
        for (int frame = 1; frame <= 100; ++frame) result = look.run(wall(frame));
        const Image& light = result.images.at("irradiance");
        double sum = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) sum += std::pow(light.at(x, y, 0) - exact.at(x, y, 0), 2);
        errors.push_back(std::sqrt(sum / (kWidth * kHeight)));
        if (std::string(hybrid) != "auto") continue;
        // Where a tile's border is not all sampled, the step over it is the exact one.
        const Image& sampled = result.taps.at("sss_adaptive.sampled");
        for (int y = 0; y < kHeight; ++y)
            for (int x = 8; x < kWidth; x += 8) {
                if (sampled.at(x, y, 0) + sampled.at(x - 1, y, 0) == 2) continue;
                const double seam =
                    (light.at(x, y, 0) - light.at(x - 1, y, 0)) - (exact.at(x, y, 0) - exact.at(x - 1, y, 0));
                EXPECT_LT(std::abs(seam), 1.0 / 255) << x << " " << y;
            }
    }
    EXPECT_NEAR(errors[1] / errors[0], 1, 0.02);
    EXPECT_LT(errors[1], 0.3 * errors[2]);
}

TEST(SssAdaptiveHybrid, LeavesTheBitsOfWhatDoesNotScatter) {
    expect_the_rest_keeps_its_bits(kEffect, R"("hybrid": "auto")");
    expect_the_rest_keeps_its_bits(kEffect, R"("hybrid": "separable")");
}

/// Samples that come to a pixel which was blurred before begin in the middle.
TEST(SssAdaptiveHybrid, FollowsLightThatBecomesLively) {
    LookRunner look =
        runner(R"("hybrid": "auto")", {"sss_adaptive.plan", "sss_adaptive.history", "sss_adaptive.sampled"});
    for (int frame = 1; frame <= 6; ++frame) {
        Capture capture = wall(frame);
        if (frame < 4)
            for (float& value : capture.images.at("irradiance").floats()) value = 0.5f;
        const FrameResult result = look.run(capture);
        const Image &history = result.taps.at("sss_adaptive.history"),
                    &sampled = result.taps.at("sss_adaptive.sampled");
        const double share = sampled.at(20, 20, 0);
        EXPECT_EQ(share, frame < 4 ? 0 : 1) << frame;
        EXPECT_EQ(history.at(20, 20, 0) >= 0, frame >= 4) << frame;
        EXPECT_GT(history.at(20, 20, 3), 0) << "whose pixel it is, always";
        EXPECT_EQ(result.taps.at("sss_adaptive.plan").at(20, 20, 1), frame < 4 ? -1 : 1) << frame;
        if (frame == 4) {
            EXPECT_EQ(result.taps.at("sss_adaptive.plan").at(20, 20, 0), 36);
        }
    }
}

/// A pixel whose light becomes lively only beside it keeps the average that the blurs began.
TEST(SssAdaptiveHybrid, GoesOnFromTheBlursWithItsAverage) {
    LookRunner look =
        runner(R"("hybrid": "auto", "guiding_weight": 0.1)", {"sss_adaptive.guided", "sss_adaptive.sampled"});
    FrameResult result;
    for (int frame = 1; frame <= 4; ++frame) {
        Capture capture = wall(frame);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                for (int c = 0; c < 3; ++c)
                    capture.images.at("irradiance").at(x, y, c) =
                        frame == 4 && x == 40 && y == 20 ? 0.6f : 0.5f;
        result = look.run(capture);
        EXPECT_EQ(result.taps.at("sss_adaptive.sampled").at(36, 24, 0), frame < 4 ? 0 : 1) << frame;
    }
    EXPECT_EQ(result.taps.at("sss_adaptive.guided").at(36, 24, 3), 10) << "1 / guiding_weight";
}

}  // namespace
}  // namespace aftershade::test::sss_adaptive_hybrid
