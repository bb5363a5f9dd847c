// A grid of pixels that are not square, and the square ones that stand for it.
#include "framework/image/square_pixels.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace aftershade {
namespace {

TEST(SquarePixels, TakeTheFractionOfLeastDenominator) {
    EXPECT_EQ(square_pixels(2), (PixelStretch{0, 2, 1}));
    EXPECT_EQ(square_pixels(0.5f), (PixelStretch{1, 2, 1}));
    EXPECT_EQ(square_pixels(1.5f), (PixelStretch{0, 3, 2}));
    EXPECT_EQ(square_pixels(1.3333f), (PixelStretch{0, 4, 3}));
    EXPECT_EQ(square_pixels(0.75f), (PixelStretch{1, 4, 3}));
    for (float aspect = 0.003f; aspect < 1000; aspect *= 1.0371f) {
        const PixelStretch stretch = square_pixels(aspect);
        EXPECT_NEAR(stretch.scale(0) / stretch.scale(1) / double(aspect), 1, 1.0 / 1999) << aspect;
        EXPECT_GE(stretch.scale(stretch.axis), 1) << aspect;
    }
}

TEST(SquarePixels, AreTheStoredOnesWhereTheAspectIsOneOrNoAspect) {
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float aspect : {1.0f, 1.0003f, 0.9998f, 0.0f, -1.0f, infinity, std::nanf("")})
        EXPECT_TRUE(square_pixels(aspect).is_none()) << aspect;
    const Window window{-3, 4, 9, 9};
    EXPECT_EQ(stretched(window, {0, 0, 5, 5}, {}), window);
}

TEST(SquarePixels, FollowOneAnotherSoThatEachStoredPixelHasAtLeastOne) {
    for (const float aspect : {2.0f, 1.5f, 1.0926f, 1.3333f, 3.7f, 0.9f, 0.4118f}) {
        const PixelStretch stretch = square_pixels(aspect);
        for (int px = -100; px < 100; ++px) {
            EXPECT_GT(stretch.edge(px + 1), stretch.edge(px)) << aspect << " at " << px;
            EXPECT_EQ(stretch.edge(px), std::floor(px * stretch.scale(stretch.axis) + 0.5))
                << aspect << " at " << px;
            const auto phase = stretch.phase(px);
            EXPECT_EQ(stretch.edge(px + 7) - stretch.edge(px), stretch.edge(phase + 7) - stretch.edge(phase));
        }
    }
}

TEST(SquarePixels, OfAPartOfAFrameAreThoseOfTheWholeFrame) {
    const Window display{10, 20, 59, 69};
    const PixelStretch stretch = square_pixels(1.5f);
    EXPECT_EQ(stretched(display, display, stretch), (Window{10, 20, 84, 69}));
    EXPECT_EQ(stretched({9, 20, 59, 69}, display, stretch).min_x, 9);  // -1 x 1.5, rounded up
    for (int x = -10; x < 80; ++x) {
        const Window left = stretched({-10, 20, x, 30}, display, stretch);
        const Window right = stretched({x + 1, 20, 90, 30}, display, stretch);
        EXPECT_EQ(left.max_x + 1, right.min_x) << x;
        EXPECT_EQ(left.min_y, 20);
    }
}

TEST(SquarePixels, BeyondAnIntEndThere) {
    const Window window{0, 0, 99999, 9};
    EXPECT_GT(stretched(window, window, square_pixels(1e6f)).width(), 1 << 29);
}

}  // namespace
}  // namespace aftershade
