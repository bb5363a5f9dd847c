#include "framework/compare/forgiveness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "framework/compare/pixel_differences.h"
#include "tests/compare/pictures.h"

namespace aftershade {
namespace {

using test::hashed;
using test::picture;

PixelDifferences forgiving(const Image& reference, const Image& test, Forgive forgive, double fail,
                           LayerRole role = LayerRole::data, const PixelAreas& areas = {}) {
    DifferenceRules rules;
    rules.fail = rules.warn = fail;
    rules.forgive = forgive;
    return pixel_differences(reference, test, role, rules, areas, 2);
}

Image shifted(const Image& image, int dx, int dy) {
    const auto clamped = [](int i, int size) { return std::min(std::max(i, 0), size - 1); };
    return picture(image.width(), image.height(), image.channels(), [&](int x, int y, int c) {
        return image.at(clamped(x - dx, image.width()), clamped(y - dy, image.height()), c);
    });
}

/// By the definition alone, in double precision: a pixel passes where each image has, within n px, a pixel
/// that is within `fail` of the other's, in every channel.
std::uint64_t failing_by_definition(const Image& a, const Image& b, int n, double fail) {
    const auto fits = [&](const Image& one, const Image& other, int x, int y) {
        for (int v = std::max(0, y - n); v <= std::min(a.height() - 1, y + n); ++v)
            for (int u = std::max(0, x - n); u <= std::min(a.width() - 1, x + n); ++u) {
                bool near = true;
                for (int c = 0; c < a.channels(); ++c)
                    near = near && std::abs(double(one.at(x, y, c)) - double(other.at(u, v, c))) <= fail;
                if (near) return true;
            }
        return false;
    };
    std::uint64_t count = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) count += fits(a, b, x, y) && fits(b, a, x, y) ? 0 : 1;
    return count;
}

TEST(ForgivenShift, IsWhatItsDefinitionSaysOfRandomPictures) {
    for (int seed = 1; seed <= 6; ++seed) {
        const Image a =
            picture(37, 23, 3, [&](int x, int y, int c) { return hashed(x / 2, y / 3, c, seed); });
        const Image b = picture(37, 23, 3, [&](int x, int y, int c) {
            return hashed((x + seed % 3) / 2, y / 3, c, seed) + 0.2f * hashed(x, y, c, seed + 9);
        });
        for (int n = 1; n <= 3; ++n)
            for (const double fail : {0.02, 0.1, 0.3})
                EXPECT_EQ(forgiving(a, b, {.shift_px = n}, fail).failing.count,
                          failing_by_definition(a, b, n, fail))
                    << "seed " << seed << ", " << n << " px, " << fail;
    }
}

TEST(ForgivenShift, LetsAPictureMoveSoFarAndNoFarther) {
    const Image image = picture(40, 30, 3, [](int x, int y, int c) { return hashed(x / 4, y / 4, c, 3); });
    const auto inner_failing = [&](int dx, int dy, int n) {
        const PixelDifferences d = forgiving(image, shifted(image, dx, dy), {.shift_px = n}, 1e-6);
        return d.failing.count;
    };
    EXPECT_GT(inner_failing(1, 0, 0), 40u * 30u / 8) << "without forgiveness much of it fails";
    EXPECT_EQ(inner_failing(1, 0, 1), 0u);
    EXPECT_EQ(inner_failing(2, -2, 2), 0u) << "in x and in y at once";
    EXPECT_GT(inner_failing(2, 0, 1), 0u);
    EXPECT_GT(inner_failing(0, 3, 2), 0u);
}

TEST(ForgivenShift, FailsALineThatOnlyOneOfTheImagesHas) {
    const Image plain = test::constant(20, 20, {0.5f});
    const Image line = picture(20, 20, 1, [](int x, int, int) { return x == 9 ? 1.0f : 0.5f; });
    for (int n = 1; n <= 4; ++n) {
        EXPECT_EQ(forgiving(line, plain, {.shift_px = n}, 0.01).failing.count, 20u) << "it vanished";
        EXPECT_EQ(forgiving(plain, line, {.shift_px = n}, 0.01).failing.count, 20u) << "it appeared";
    }
    EXPECT_EQ(forgiving(line, shifted(line, 1, 0), {.shift_px = 1}, 0.01).failing.count, 0u) << "it moved";
}

TEST(ForgivenShift, CountsWhatItForgivesAndLeavesTheFiguresAlone) {
    const Image line = picture(20, 20, 1, [](int x, int, int) { return x == 9 ? 1.0f : 0.5f; });
    const Image moved = shifted(line, 1, 0);
    const PixelDifferences own = forgiving(line, moved, {}, 0.01);
    const PixelDifferences d = forgiving(line, moved, {.shift_px = 1}, 0.01);
    EXPECT_EQ(own.failing.count, 40u);
    EXPECT_EQ(own.forgiven, 0u);
    EXPECT_EQ(d.forgiven, 40u);
    EXPECT_EQ(d.rmse, own.rmse);
    EXPECT_EQ(d.largest.value, 0.5);
    EXPECT_EQ(d.largest_pixel, 0.5);
    EXPECT_FALSE(d.bits_equal);
}

TEST(ForgivenShift, HoldsForIdsDepthAndNan) {
    EXPECT_EQ(forgiving(test::ids({1, 1, 7, 7}), test::ids({1, 7, 7, 7}), {.shift_px = 1}, 0, LayerRole::id)
                  .failing.count,
              0u);
    EXPECT_EQ(forgiving(test::ids({1, 1, 7, 7}), test::ids({1, 8, 7, 7}), {.shift_px = 1}, 0, LayerRole::id)
                  .failing.count,
              1u);
    using test::kInfinity;
    using test::kNan;
    const Image depth = test::row({2, 2, 4, kInfinity}), nearer = test::row({2, 4, 4, kInfinity});
    EXPECT_EQ(forgiving(depth, nearer, {.shift_px = 1}, 0.01, LayerRole::depth).failing.count, 0u);
    EXPECT_EQ(forgiving(test::row({1, 1, 1}), test::row({1, kNan, 1}), {.shift_px = 1}, 1e9).failing.count,
              1u)
        << "NaN is near to nothing";
}

TEST(ForgivenShift, MatchesNothingThatIsLeftOut) {
    PixelAreas areas;
    areas.of_pixel = {0, PixelAreas::kLeftOut, 0, 0};
    const PixelDifferences d = forgiving(test::row({3, 9, 1, 1}), test::row({9, 3, 1, 1}), {.shift_px = 1},
                                         0.1, LayerRole::data, areas);
    EXPECT_EQ(d.pixels, 3u);
    EXPECT_EQ(d.left_out, 1u);
    EXPECT_EQ(d.failing.count, 1u) << "its only match is left out";
}

/// A Gaussian over both images, cut off at 3 sigma, by one sum over the plane instead of two passes.
std::uint64_t failing_after_blur(const Image& a, const Image& b, double sigma_px, double fail) {
    const int radius = int(std::ceil(3 * sigma_px));
    std::uint64_t count = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            double difference = 0, weights = 0;
            for (int v = std::max(0, y - radius); v <= std::min(a.height() - 1, y + radius); ++v)
                for (int u = std::max(0, x - radius); u <= std::min(a.width() - 1, x + radius); ++u) {
                    const double weight =
                        std::exp(-0.5 * ((u - x) * (u - x) + (v - y) * (v - y)) / (sigma_px * sigma_px));
                    difference += weight * (double(a.at(u, v, 0)) - double(b.at(u, v, 0)));
                    weights += weight;
                }
            const double own = std::abs(double(a.at(x, y, 0)) - double(b.at(x, y, 0)));
            count += std::min(own, std::abs(difference / weights)) > fail ? 1 : 0;
        }
    return count;
}

TEST(ForgivenBlur, IsWhatItsDefinitionSaysOfRandomPictures) {
    const Image a = picture(31, 27, 1, [](int x, int y, int c) { return hashed(x, y, c, 1); });
    const Image b = picture(31, 27, 1, [](int x, int y, int c) {
        return 0.5f * (hashed(x, y, c, 1) + hashed(std::max(x - 1, 0), y, c, 1));
    });
    for (const double sigma_px : {0.5, 1.0, 2.5})
        for (const double fail : {0.0205, 0.0507, 0.1003}) {
            const std::uint64_t expected = failing_after_blur(a, b, sigma_px, fail);
            EXPECT_EQ(forgiving(a, b, {.blur_px = sigma_px}, fail).failing.count, expected)
                << sigma_px << " px, " << fail;
            EXPECT_LT(expected, forgiving(a, b, {}, fail).failing.count);
        }
}

TEST(ForgivenBlur, FailsALineThatVanishes) {
    const Image plain = test::constant(20, 20, {0.5f});
    const Image line = picture(20, 20, 1, [](int x, int, int) { return x == 9 ? 1.0f : 0.5f; });
    // After sigma 1 the line's middle keeps 1 / sqrt(2 pi) of its 0.5: 0.2.
    EXPECT_EQ(forgiving(line, plain, {.blur_px = 1}, 0.15).failing.count, 20u);
    EXPECT_EQ(forgiving(line, plain, {.blur_px = 1}, 0.25).failing.count, 0u);
}

TEST(ForgivenBlur, LeavesIdsAndWhatIsNoNumberAlone) {
    EXPECT_EQ(forgiving(test::ids({1, 2, 3}), test::ids({1, 9, 3}), {.blur_px = 8}, 1e9, LayerRole::id)
                  .failing.count,
              1u);
    const PixelDifferences d =
        forgiving(test::row({1, 1, 1, 1}), test::row({1, test::kNan, 1, 1.2f}), {.blur_px = 2}, 0.15);
    EXPECT_EQ(d.failing.count, 1u) << "the NaN alone: its neighbours do not see it";
    EXPECT_EQ(d.forgiven, 1u);
}

}  // namespace
}  // namespace aftershade
