// What dof guesses to lie behind a silhouette from what stands beside it: against closed forms.
#include <cmath>

#include <gtest/gtest.h>

#include "effects/dof/dof_bars.h"

namespace aftershade::test::dof {
namespace {

/// A patch is never brighter than what it continues: a light in focus beside a wire stays as large as it is.
TEST(DofBehind, ALightBesideAWireIsNotContinuedBehindIt) {
    const Column wire{0.05f, true};
    Capture capture = columns_over_stripes(47, {wire, wire, wire});
    for (int y = 30; y < 33; ++y)
        for (int x = 50; x < 53; ++x)
            for (int c = 0; c < 3; ++c) capture.images["color"].at(x, y, c) = 40;
    const Image out = blurred(capture);
    for (int y = 29; y < 34; ++y)
        for (int x = 46; x < 50; ++x) EXPECT_LE(out.at(x, y, 0), 1) << x << " " << y;
}

/// A wire crosses an antialiased lamp in focus: pixels that both share have the wire's depth and much of the
/// lamp's light, and pixels of the stripes beside them take it for a light of the wire.
TEST(DofBehind, ALampBehindAWireThrowsNoDiskOfTheWires) {
    Capture capture = columns_over_stripes(47, {{0.05f, true}});
    const auto light = [&](int x, int y, float amount) {
        for (int c = 0; c < 3; ++c) capture.images["color"].at(x, y, c) = amount;
    };
    for (const int y : {31, 32}) {
        light(47, y, 25);
        light(48, y, 40);
        light(49, y, 40);
    }
    for (const int y : {30, 33}) {
        light(48, y, 20);
        light(49, y, 20);
    }
    const Image out = blurred(capture);
    // The wire lacks the two pixels that the lamp has.
    for (int y = 20; y < 44; ++y) {
        if (y % 8 < 2 || y % 8 > 5) continue;
        for (int x = 32; x < 64; ++x) {
            if (std::hypot(x - 48, y - 32) < 4) continue;
            const double opacity = bar_opacity(x, 47, 48);
            EXPECT_NEAR(out.at(x, y, 0), opacity * 0.05 + (1 - opacity) * double(stripe(y)), 0.025)
                << x << " " << y;
        }
    }
}

/// Across a wire's side the darker stripe is like a mixture of the lighter one and the wire. It is none: the
/// stripe goes on.
TEST(DofBehind, AnEdgeOfWhatIsInFocusStaysSharpBesideAWire) {
    Capture capture = columns_over_stripes(47, {{0.02f, true}, {0.02f, true}});
    const auto half = [](int y) { return y < 32 ? 0.5f : 0.18f; };
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (int c = 0; c < 3 && x != 47 && x != 48; ++c) capture.images["color"].at(x, y, c) = half(y);
    const Image out = blurred(capture);
    for (int y = 28; y < 36; ++y)
        for (const int x : {45, 46, 49, 50}) {
            const double opacity = bar_opacity(x, 47, 49);
            EXPECT_NEAR(out.at(x, y, 0), opacity * 0.02 + (1 - opacity) * double(half(y)), 0.02)
                << x << " " << y;
        }
}

// Short chords across the pole all have unlike ends; those along the edge alone say on which side of it a
// pixel lies.
TEST(DofBehind, AnEdgeThatCrossesAPoleAtASmallAngleGoesOnBehindIt) {
    constexpr int kEdge = kWidth / 2;
    constexpr double kSlope = 1.0 / 5, kHalfWidthPx = 0.6, kPole = 0.05;
    const auto beside = [](int x) { return x < kEdge ? 0.8f : 0.2f; };
    const auto off_pole = [](int x, int y) { return x + 0.5 - kEdge - kSlope * (y + 0.5 - kHeight / 2); };
    Capture capture =
        make_capture({.width = kWidth, .height = kHeight, .background_depth_m = kApertureFocusM}, 0);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const bool is_pole = std::abs(off_pole(x, y)) < kHalfWidthPx;
            for (int c = 0; c < 3; ++c)
                capture.images["color"].at(x, y, c) = is_pole ? float(kPole) : beside(x);
            if (is_pole) capture.images["depth"].at(x, y, 0) = kApertureFocusM / 2;
        }
    const Image out = blurred(capture);
    const double across = 1 / std::sqrt(1 + kSlope * kSlope) / kRadiusPx;
    double error = 0;
    int count = 0;
    for (int y = 24; y < 40; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const double off = off_pole(x, y);
            if (std::abs(off) >= kHalfWidthPx) continue;
            const double opacity =
                disk_left_of((kHalfWidthPx - off) * across) - disk_left_of((-kHalfWidthPx - off) * across);
            error += std::abs(out.at(x, y, 0) - opacity * kPole - (1 - opacity) * double(beside(x)));
            ++count;
        }
    EXPECT_LT(error / count, 0.03);  // by 12 chords of any length it was 0.054
}

/// A bar stands a little in front of fine stripes, whose CoC differs less from its own than the ends of one
/// surface may: what it hides is not continued from the bar itself.
TEST(DofBehind, ABarIsNotContinuedBehindItself) {
    constexpr double kStripesPx = 3, kBarPx = 4.5, kBar = 0.05;
    constexpr int kLeft = 44, kRight = 52;
    const auto depth_of = [](double coc_px) { return float(kApertureFocusM / (1 + coc_px / kRadiusPx)); };
    const auto light = [](double y) { return std::fmod(y, 4.0) < 2 ? 0.2f : 0.8f; };
    Capture capture =
        make_capture({.width = kWidth, .height = kHeight, .background_depth_m = depth_of(kStripesPx)}, 0);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const bool is_bar = x >= kLeft && x < kRight;
            for (int c = 0; c < 3; ++c)
                capture.images["color"].at(x, y, c) = is_bar ? float(kBar) : light(y + 0.5);
            if (is_bar) capture.images["depth"].at(x, y, 0) = depth_of(kBarPx);
        }
    const Image out = blurred(capture);
    // The mean over points of the lens.
    constexpr int kLens = 41;
    const auto seen = [&](int x, int y) {
        double sum = 0;
        int count = 0;
        for (int i = 0; i < kLens * kLens; ++i) {
            const double u = (i % kLens + 0.5) * 2 / kLens - 1, v = (i / kLens + 0.5) * 2 / kLens - 1;
            if (u * u + v * v >= 1) continue;
            const double at = x + 0.5 + kBarPx * u;
            sum += at >= kLeft && at < kRight ? kBar : double(light(y + 0.5 + kStripesPx * v));
            ++count;
        }
        return sum / count;
    };
    double error = 0;
    for (int y = 20; y < 44; ++y)
        for (int x = kLeft; x < kRight; ++x)
            error += std::abs(out.at(x, y, 0) - seen(x, y)) / (24 * (kRight - kLeft));
    EXPECT_LT(error, 0.012);  // 0.023 with chords that end on the bar
}

/// A chord that ends at the border, beyond which nothing is known, takes nothing from there.
TEST(DofBehind, APoleAtTheRightBorderIsTheMirroredOneAtTheLeft) {
    const auto with_pole = [](bool at_right) {
        Capture capture =
            make_capture({.width = kWidth, .height = kHeight, .background_depth_m = kApertureFocusM}, 0);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const int from_border = at_right ? kWidth - 1 - x : x;
                const float stripe = (from_border + 2 * y) % 16 < 8 ? 0.8f : 0.2f;
                for (int c = 0; c < 3; ++c)
                    capture.images["color"].at(x, y, c) = from_border < 3 ? 0.05f : stripe;
                if (from_border < 3) capture.images["depth"].at(x, y, 0) = kApertureFocusM / 2;
            }
        return blurred(capture);
    };
    const Image right = with_pole(true), left = with_pole(false);
    for (int y = 8; y < kHeight - 8; ++y)
        for (int x = 0; x < 12; ++x)
            ASSERT_NEAR(right.at(kWidth - 1 - x, y, 0), left.at(x, y, 0), 1e-3) << x << " " << y;
}

}  // namespace
}  // namespace aftershade::test::dof
