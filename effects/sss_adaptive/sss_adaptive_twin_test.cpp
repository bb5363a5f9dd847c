// The arithmetic over frames by itself: windows and moving means, and the control variates of Xie and Olano
// 2021 on their own one-dimensional example, the integral of 1 / (1 + y) over 0..1 with 1 - y as its variate,
// under light T = 3 sin + 1.
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/reference/adaptive_sampling.h"

namespace aftershade::test::sss_adaptive_twin {
namespace {

using namespace reference;

constexpr double kLn2 = std::numbers::ln2;

struct Estimates {
    double value = 0;    ///< mean of 1 / (1 + y)
    double variate = 0;  ///< mean of 1 - y
};

Estimates estimate(int samples, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform;
    Estimates sum;
    for (int i = 0; i < samples; ++i) {
        const double y = uniform(random);
        sum.value += 1 / (1 + y) / samples;
        sum.variate += (1 - y) / samples;
    }
    return sum;
}

double light_at(int frame) {
    return 3 * std::sin(2 * std::numbers::pi * frame / 24) + 1;
}

TEST(AdaptiveSampling, HasInAMovingMeanTheVarianceOfAWindow) {
    std::mt19937 random(1);
    std::normal_distribution<double> noise(2, 1);
    for (const int k : {4, 9, 19}) {
        FrameWindow window{std::size_t(k)};
        MovingMoments moving(2.0 / (k + 1), 2, 1);
        double window_squares = 0, moving_squares = 0, variances = 0;
        const int frames = 200000;
        for (int i = 0; i < frames; ++i) {
            const double value = noise(random);
            window.add(value);
            moving.add(value);
            if (i < 200) continue;
            window_squares += std::pow(window.mean() - 2, 2) / (frames - 200);
            moving_squares += std::pow(moving.mean() - 2, 2) / (frames - 200);
            variances += moving.variance() / (frames - 200);
        }
        EXPECT_NEAR(window_squares, 1.0 / k, 0.03 / k) << k;
        EXPECT_NEAR(moving_squares, 1.0 / k, 0.03 / k) << k;
        // About a mean that moves along, 1 / k less than the values have.
        EXPECT_NEAR(variances, 1 - 1.0 / k, 0.01) << k;
    }
}

/// Where counts and variance are steady, the published sums and their O(1) form want the same.
TEST(AdaptiveSampling, WantsAsManyByMovingMeansAsByWindows) {
    for (const double excess : {0.5, 1.0, 1.3})
        for (const int k : {4, 9, 19}) {
            const std::deque<double> counts(std::size_t(k), 20.0);
            EXPECT_NEAR(next_count_of_window(counts, excess * 1e-3, 1e-3),
                        next_count_by_difference(20, 2.0 / (k + 1), excess * 1e-3, 1e-3), 1e-9)
                << k << " " << excess;
        }
}

TEST(ControlVariates, HaveTheFactorsOfTheirExample) {
    // Of one frame, the light at rest: covariance over variance of the integrands.
    const double covariance = 1.5 * kLn2 - 1, variance = 1.0 / 12;
    EXPECT_NEAR(covariance / variance, 0.477, 5e-4);
    // Of the light alone, constant within a frame: F over G.
    EXPECT_NEAR(kLn2 / 0.5, 1.386, 5e-4);
    // Over frames of n samples both are in it, E[T] = 1 and E[T^2] = 5.5: the more samples, the more of it is
    // the light.
    const auto factor = [&](double n) {
        return (5.5 * (kLn2 / 2 + covariance / n) - kLn2 / 2) / (5.5 * (0.25 + variance / n) - 0.25);
    };
    EXPECT_NEAR(factor(1), 1.123, 5e-4);
    EXPECT_NEAR(factor(16), 1.364, 5e-4);
    EXPECT_NEAR(factor(1024), 1.3859, 5e-4);
}

TEST(ControlVariates, AreFoundOnlineOver120Frames) {
    std::mt19937 random(2);
    const Estimates first = estimate(1024, random);
    MovingCovariance moments(0.02, light_at(0) * first.value, light_at(0) * first.variate);
    for (int frame = 1; frame < 120; ++frame) {
        const Estimates now = estimate(1024, random);
        moments.add(light_at(frame) * now.value, light_at(frame) * now.variate);
    }
    EXPECT_NEAR(moments.factor(), 1.388, 0.004);
}

/// What a pixel follows then is the noise of the samples, not the light that moves.
TEST(ControlVariates, LeaveTheNoiseOfTheSamplesAlone) {
    std::mt19937 random(3);
    const int samples = 64;
    MovingMoments plain(0.2, kLn2, 0), constant(0.2, 0, 0), still(0.2, kLn2, 0);
    double plain_sum = 0, constant_sum = 0, still_sum = 0;
    for (int frame = 0; frame < 120; ++frame) {
        const Estimates now = estimate(samples, random);
        const double light = light_at(frame), variate = 0.5 * light;  // known exactly within the frame
        plain.add(light * now.value);
        constant.add(light * now.value - kLn2 / 0.5 * variate);
        still.add(now.value);
        plain_sum += plain.variance() / 120;
        constant_sum += constant.variance() / 120;
        still_sum += still.variance() / 120;
    }
    // Without: the light's own variance, 4.5 times F^2. With: the samples', times E[T^2].
    EXPECT_GT(plain_sum, 0.5 * 4.5 * kLn2 * kLn2);
    EXPECT_NEAR(constant_sum / still_sum, 5.5, 1.5);
    EXPECT_LT(constant_sum, plain_sum / 200);
}

}  // namespace
}  // namespace aftershade::test::sss_adaptive_twin
