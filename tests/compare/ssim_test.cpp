#include "framework/compare/ssim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/compare/pictures.h"

namespace aftershade {
namespace {

using test::constant;
using test::hashed;
using test::picture;

Image noise(int width, int height, int channels, int seed) {
    return picture(width, height, channels, [=](int x, int y, int c) { return hashed(x, y, c, seed); });
}

double ssim(const Image& reference, const Image& test, int threads = 1) {
    return ssim_figures(reference, test, threads).ssim;
}

std::optional<double> ms_ssim(const Image& reference, const Image& test, int threads = 1) {
    return ssim_figures(reference, test, threads).ms_ssim;
}

/// Wang et al. 2004, equations 6 and 13 to 16, in two dimensions, of the window around one pixel.
double definition_at(const Image& a, const Image& b, int channel, int cx, int cy) {
    double weights = 0, ma = 0, mb = 0;
    const auto each = [&](auto visit) {
        for (int y = -5; y <= 5; ++y)
            for (int x = -5; x <= 5; ++x)
                visit(std::exp(-(x * x + y * y) / 4.5), double(a.at(cx + x, cy + y, channel)),
                      double(b.at(cx + x, cy + y, channel)));
    };
    each([&](double w, double u, double v) { weights += w, ma += w * u, mb += w * v; });
    ma /= weights, mb /= weights;
    double va = 0, vb = 0, cov = 0;
    each([&](double w, double u, double v) {
        va += w / weights * (u - ma) * (u - ma);
        vb += w / weights * (v - mb) * (v - mb);
        cov += w / weights * (u - ma) * (v - mb);
    });
    return (2 * ma * mb + 1e-4) * (2 * cov + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
}

double definition(const Image& a, const Image& b, int channel) {
    double total = 0;
    int count = 0;
    for (int y = 5; y < a.height() - 5; ++y)
        for (int x = 5; x < a.width() - 5; ++x, ++count) total += definition_at(a, b, channel, x, y);
    return total / count;
}

TEST(Ssim, OfAnImageAndItselfIsOne) {
    const Image image = noise(40, 30, 3, 1);
    EXPECT_NEAR(ssim(image, image), 1, 1e-12);
}

TEST(Ssim, OfConstantsIsItsTermOfMeans) {
    const double a = 0.25, b = 0.75;
    EXPECT_NEAR(ssim(constant(20, 20, {0.25f}), constant(20, 20, {0.75f})),
                (2 * a * b + 1e-4) / (a * a + b * b + 1e-4), 1e-12);
}

TEST(Ssim, FollowsItsDefinition) {
    const Image a = noise(31, 26, 2, 1);
    const Image b = picture(
        31, 26, 2, [&](int x, int y, int c) { return 0.7f * a.at(x, y, c) + 0.3f * hashed(x, y, c, 2); });
    EXPECT_NEAR(ssim(a, b), (definition(a, b, 0) + definition(a, b, 1)) / 2, 1e-10);
}

TEST(Ssim, HasAMapOfItsWindowsWhoseMeanItIs) {
    const Image a = noise(31, 26, 2, 1), b = noise(31, 26, 2, 2);
    Image map;
    const double mean = ssim_figures(a, b, 2, {}, &map).ssim;
    ASSERT_TRUE(map.width() == 31 && map.height() == 26 && map.channels() == 1);
    double sum = 0;
    int count = 0;
    for (int y = 0; y < 26; ++y)
        for (int x = 0; x < 31; ++x) {
            const bool inside = x >= 5 && x < 26 && y >= 5 && y < 21;
            ASSERT_EQ(std::isnan(map.at(x, y, 0)), !inside) << x << ", " << y;
            if (!inside) continue;
            ASSERT_NEAR(map.at(x, y, 0), (definition_at(a, b, 0, x, y) + definition_at(a, b, 1, x, y)) / 2,
                        1e-6);
            sum += map.at(x, y, 0), ++count;
        }
    EXPECT_NEAR(sum / count, mean, 1e-6);
}

TEST(Ssim, OfPicturesBelowItsWindowIsDefined) {
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 30}, {30, 4}, {10, 10}}) {
        const double a = 0.25, b = 0.75;
        EXPECT_NEAR(ssim(constant(width, height, {0.25f}), constant(width, height, {0.75f})),
                    (2 * a * b + 1e-4) / (a * a + b * b + 1e-4), 1e-12);
        const Image image = noise(width, height, 3, 1);
        EXPECT_NEAR(ssim(image, image), 1, 1e-12);
        EXPECT_LT(ssim(image, noise(width, height, 3, 2)), 0.99);
    }
}

TEST(Ssim, IsTheSameOnAnyNumberOfThreads) {
    const Image a = noise(200, 300, 3, 1), b = noise(200, 300, 3, 2);
    const double one = ssim(a, b, 1), scales = *ms_ssim(a, b, 1);
    for (const int threads : {2, 5}) {
        EXPECT_EQ(ssim(a, b, threads), one);
        EXPECT_EQ(*ms_ssim(a, b, threads), scales);
    }
}

TEST(MsSsim, NeedsFiveScales) {
    EXPECT_EQ(kMsSsimMinSide_px, 176);
    EXPECT_FALSE(ms_ssim(noise(175, 400, 1, 1), noise(175, 400, 1, 1)));
    EXPECT_TRUE(ms_ssim(noise(176, 176, 1, 1), noise(176, 176, 1, 1)));
}

TEST(MsSsim, OfConstantsIsTheirTermOfMeansAtTheCoarsestScale) {
    const double a = 0.25, b = 0.75;
    EXPECT_NEAR(*ms_ssim(constant(180, 180, {0.25f}), constant(180, 180, {0.75f})),
                std::pow((2 * a * b + 1e-4) / (a * a + b * b + 1e-4), 0.1333), 1e-12);
}

TEST(MsSsim, ForgivesFineNoiseMoreThanCoarse) {
    const Image grey = constant(256, 256, {0.5f});
    const auto noisy = [&](int cell) {
        return picture(256, 256, 1,
                       [=](int x, int y, int) { return 0.4f + 0.2f * hashed(x / cell, y / cell, 0, 1); });
    };
    const Image fine = noisy(1), coarse = noisy(16);
    EXPECT_GT(*ms_ssim(grey, fine), *ms_ssim(grey, coarse) + 0.1);
}

}  // namespace
}  // namespace aftershade
