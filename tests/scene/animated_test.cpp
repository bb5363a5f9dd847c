#include "framework/scene/animated.h"

#include <cmath>

#include <gtest/gtest.h>

namespace aftershade::scene {
namespace {

const Animated<double> kRamp({{2, 10}, {4, 20}, {8, 0}}, Interpolation::linear);

TEST(Animated, RunsStraightBetweenKeysAndHoldsOutside) {
    EXPECT_DOUBLE_EQ(kRamp.at(3), 15);
    EXPECT_DOUBLE_EQ(kRamp.at(7), 5);
    EXPECT_DOUBLE_EQ(kRamp.at(4), 20);
    EXPECT_DOUBLE_EQ(kRamp.at(-5), 10);
    EXPECT_DOUBLE_EQ(kRamp.at(99), 0);
}

TEST(Animated, KeepsAStepUntilTheNextKey) {
    const Animated<double> steps({{1, 5}, {3, 7}}, Interpolation::step);
    EXPECT_DOUBLE_EQ(steps.at(2.999), 5);
    EXPECT_DOUBLE_EQ(steps.at(3), 7);
}

TEST(Animated, RestsAtTheKeysOfASmoothCurve) {
    const Animated<double> smooth({{0, 0}, {10, 1}}, Interpolation::smooth);
    EXPECT_DOUBLE_EQ(smooth.at(5), 0.5);
    EXPECT_NEAR(smooth.at(0.01) / 0.01, 0, 1e-3);
    EXPECT_NEAR(smooth.at(2.5), std::pow(std::sin(std::acos(-1) / 8), 2), 0.02);
}

TEST(Animated, GoesOnBeforeAndAfterAShotAsItMovedInside) {
    const Shot shot{3, 6};
    // At frame 3 it rises by 5 a frame: half a frame earlier, in the same shot, it was 2.5 lower.
    EXPECT_DOUBLE_EQ(kRamp.at(2.5, shot), 12.5);
    // At frame 6 it falls by 5 a frame, though the next shot might begin elsewhere.
    EXPECT_DOUBLE_EQ(kRamp.at(6.5, shot), 7.5);
    EXPECT_DOUBLE_EQ(kRamp.at(4.5, shot), kRamp.at(4.5));
}

TEST(Animated, HoldsAStepAndAShotOfOneFrame) {
    const Animated<double> steps({{1, 5}, {4, 7}}, Interpolation::step);
    EXPECT_DOUBLE_EQ(steps.at(3.5, Shot{4, 9}), 7);
    EXPECT_DOUBLE_EQ(kRamp.at(3.5, Shot{3, 3}), 15);
}

}  // namespace
}  // namespace aftershade::scene
