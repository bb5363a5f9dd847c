#include "framework/compare/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/compare/pictures.h"

namespace aftershade {
namespace {

using test::constant;
using test::hashed;
using test::kInfinity;
using test::kNan;
using test::picture;

using Rgb = std::array<double, 3>;

/// CIELab with Hunt's adjustment by the textbook (D65 of the sRGB primaries), in double precision.
Rgb hunt_lab(const Rgb& rgb) {
    const Rgb xyz = {0.4123907993 * rgb[0] + 0.3575843394 * rgb[1] + 0.1804807884 * rgb[2],
                     0.2126390059 * rgb[0] + 0.7151686788 * rgb[1] + 0.0721923154 * rgb[2],
                     0.0193308187 * rgb[0] + 0.1191947798 * rgb[1] + 0.9505321522 * rgb[2]};
    const auto f = [](double t) {
        return t > std::pow(6.0 / 29, 3) ? std::cbrt(t) : t / (3 * 36.0 / 841) + 4.0 / 29;
    };
    const double x = f(xyz[0] / 0.9504559271), y = f(xyz[1]), z = f(xyz[2] / 1.0890577508);
    const double l = 116 * y - 16;
    return {l, 0.01 * l * 500 * (x - y), 0.01 * l * 200 * (y - z)};
}

double color_distance(const Rgb& reference, const Rgb& test) {
    const Rgb r = hunt_lab(reference), t = hunt_lab(test);
    return std::pow(std::abs(r[0] - t[0]) + std::hypot(r[1] - t[1], r[2] - t[2]), 0.7);
}

/// Of constant pictures nothing is left of the filters: the colour term alone.
double flip_of_constants(const Rgb& reference, const Rgb& test) {
    const double largest = color_distance({0, 1, 0}, {0, 0, 1}), cut = 0.4 * largest;
    const double distance = color_distance(reference, test);
    if (distance < cut) return distance / cut * 0.95;
    return 0.95 + (distance - cut) / (largest - cut) * 0.05;
}

Image of(const Rgb& rgb, int width = 5, int height = 4) {
    return constant(width, height, {float(rgb[0]), float(rgb[1]), float(rgb[2])});
}

TEST(Flip, OfConstantsIsTheirColourDistance) {
    const std::array<std::array<Rgb, 2>, 6> pairs = {{{{{0, 0, 0}, {1, 1, 1}}},
                                                      {{{0.5, 0.5, 0.5}, {0.52, 0.5, 0.5}}},
                                                      {{{0, 1, 0}, {0, 0, 1}}},
                                                      {{{0.2, 0.7, 0.1}, {0.3, 0.1, 0.9}}},
                                                      {{{0.001, 0.002, 0.001}, {0.002, 0.001, 0}}},
                                                      {{{1, 0, 0}, {0.9, 0.05, 0.02}}}}};
    for (const auto& [reference, test] : pairs) {
        const FlipResult result = ldr_flip(of(reference), of(test));
        EXPECT_NEAR(result.mean, flip_of_constants(reference, test), 2e-4);
        EXPECT_NEAR(result.max, result.mean, 1e-6);
    }
    EXPECT_NEAR(ldr_flip(of({0, 1, 0}), of({0, 0, 1})).mean, 1, 1e-5) << "the largest distance there is";
}

TEST(Flip, OfAnImageAndItselfIsNone) {
    const Image image = picture(50, 40, 3, [](int x, int y, int c) { return 40 * hashed(x, y, c, 1); });
    EXPECT_EQ(ldr_flip(image, image).max, 0);
    EXPECT_EQ(hdr_flip(image, image).max, 0);
}

TEST(Flip, IsSymmetricForDisplayedPictures) {
    const Image a = picture(40, 30, 3, [](int x, int y, int c) { return hashed(x, y, c, 1); });
    const Image b = picture(40, 30, 3, [](int x, int y, int c) { return hashed(x, y, c, 2); });
    EXPECT_NEAR(ldr_flip(a, b).mean, ldr_flip(b, a).mean, 1e-7);
}

TEST(Flip, TellsTheLargestErrorsPlace) {
    const Image reference(60, 50, 3);
    Image test(60, 50, 3);
    for (int c = 0; c < 3; ++c) test.at(41, 13, c) = 1;
    const FlipResult result = ldr_flip(reference, test);
    EXPECT_EQ(result.max_x, 41);
    EXPECT_EQ(result.max_y, 13);
    EXPECT_EQ(result.max, result.error.at(41, 13, 0));
    EXPECT_EQ(result.error.at(5, 45, 0), 0) << "out of the filters' reach";
}

TEST(Flip, SeesLessOfAPixelFromFarther) {
    const Image reference(60, 60, 3);
    Image test(60, 60, 3);
    for (int c = 0; c < 3; ++c) test.at(30, 30, c) = 0.2f;
    FlipOptions near, far;
    near.pixels_per_degree = 20;
    far.pixels_per_degree = 120;
    EXPECT_GT(ldr_flip(reference, test, near).max, 1.5 * ldr_flip(reference, test, far).max);
}

TEST(Flip, KnowsThePixelsPerDegreeOfADisplay) {
    EXPECT_NEAR(pixels_per_degree(0.7, 3840, 0.7), FlipOptions().pixels_per_degree, 1e-6);
}

TEST(Flip, IsTheSameBitsOnAnyNumberOfThreads) {
    const Image reference = picture(83, 201, 3, [](int x, int y, int c) { return 3 * hashed(x, y, c, 1); });
    const Image test = picture(83, 201, 3, [](int x, int y, int c) { return 3 * hashed(x, y, c, 2); });
    FlipOptions options;
    options.threads = 1;
    const FlipResult one = hdr_flip(reference, test, options);
    for (const int threads : {2, 3, 7}) {
        options.threads = threads;
        const FlipResult more = hdr_flip(reference, test, options);
        EXPECT_EQ(one.mean, more.mean);
        EXPECT_TRUE(std::ranges::equal(one.error.floats(), more.error.floats()));
    }
}

TEST(Flip, OfPicturesNarrowerThanItsFiltersIsDefined) {
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 70}, {70, 1}, {3, 2}}) {
        const double expected = flip_of_constants({0.2, 0.2, 0.2}, {0.6, 0.6, 0.6});
        EXPECT_NEAR(ldr_flip(of({0.2, 0.2, 0.2}, width, height), of({0.6, 0.6, 0.6}, width, height)).mean,
                    expected, 2e-4)
            << width << " x " << height;
    }
}

TEST(Flip, OfNanIsTheLargestErrorThereAndNoNanAround) {
    const Image reference = of({0.5, 0.5, 0.5}, 40, 40);
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
        Image test = reference;
        test.at(20, 20, 1) = bad;
        for (const FlipResult& result : {ldr_flip(reference, test), hdr_flip(reference, test)}) {
            EXPECT_EQ(result.error.at(20, 20, 0), 1);
            EXPECT_EQ(result.error.at(22, 20, 0), 0) << "black in both images, for the neighbours";
            EXPECT_EQ(result.mean, 1.0 / 1600);
        }
        EXPECT_EQ(ldr_flip(test, test).max, 0);
    }
}

TEST(HdrFlip, ExposesFromTheReferencesBrightestToItsMedian) {
    // White of ACES: 2.51 x^2 0.36 + 0.018 x = 0.85 (0.36 2.43 x^2 + 0.354 x + 0.14).
    const double a = 0.9036 - 0.85 * 0.8748, b = 0.018 - 0.85 * 0.354, c = -0.85 * 0.14;
    const double white = (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
    Image reference = of({0.25, 0.25, 0.25}, 20, 20);
    for (int channel = 0; channel < 3; ++channel) reference.at(3, 3, channel) = 64;
    const FlipExposures exposures = flip_exposures(reference, reference, {});
    EXPECT_NEAR(exposures.start, std::log2(white / 64), 1e-4);
    EXPECT_NEAR(exposures.stop, std::log2(white / 0.25), 1e-4);
    EXPECT_EQ(exposures.count, 8);
    EXPECT_NEAR(exposures.at(7), exposures.stop, 1e-6);
}

TEST(HdrFlip, TakesTheExposuresGiven) {
    const Image reference = of({0.25, 0.5, 0.75}, 8, 8), test = of({0.3, 0.5, 0.75}, 8, 8);
    FlipOptions options;
    options.start_exposure = -2;
    options.stop_exposure = 1.5;
    FlipResult result = hdr_flip(reference, test, options);
    EXPECT_EQ(result.start_exposure, -2);
    EXPECT_EQ(result.stop_exposure, 1.5);
    EXPECT_EQ(result.exposures, 4);
    options.exposures = 1;
    result = hdr_flip(reference, test, options);
    EXPECT_EQ(result.exposures, 1);
    EXPECT_TRUE(std::isfinite(result.mean)) << "one exposure is the start, no division by zero steps";
    options = {};
    options.start_exposure = 50;
    EXPECT_EQ(hdr_flip(reference, test, options).stop_exposure, 50) << "never below the start";
}

TEST(HdrFlip, OfABlackReferenceTakesExposuresFromTheTestImage) {
    const Image black(16, 16, 3);
    Image light = black;
    for (int c = 0; c < 3; ++c) light.at(4, 4, c) = 1000, light.at(9, 9, c) = light.at(14, 2, c) = 2;
    const FlipResult result = hdr_flip(black, light);
    EXPECT_TRUE(std::isfinite(result.start_exposure) && std::isfinite(result.stop_exposure));
    EXPECT_EQ(result.start_exposure, flip_exposures(light, light, {}).start);
    EXPECT_GT(result.error.at(4, 4, 0), 0.3);
    EXPECT_GT(result.error.at(9, 9, 0), 0.3);
}

TEST(HdrFlip, OfTwoBlackPicturesIsNone) {
    const Image black(16, 16, 3);
    const FlipResult result = hdr_flip(black, black);
    EXPECT_EQ(result.max, 0);
    EXPECT_EQ(result.start_exposure, 0);
    EXPECT_EQ(result.stop_exposure, 0);
    EXPECT_EQ(result.exposures, 2);
}

TEST(HdrFlip, OfAMostlyBlackReferenceTakesTheMedianOfItsLight) {
    Image reference(20, 20, 3);
    for (int c = 0; c < 3; ++c)
        reference.at(4, 4, c) = 8, reference.at(9, 9, c) = 2, reference.at(1, 1, c) = 4;
    const FlipExposures exposures = flip_exposures(reference, reference, {});
    EXPECT_NEAR(exposures.stop - exposures.start, 1, 1e-6) << "from 8 to 4, the middle one of three";
}

TEST(HdrFlip, SeesWhatIsBurntOutAtOneExposure) {
    const Image reference = of({50, 50, 50}, 16, 16), test = of({60, 60, 60}, 16, 16);
    EXPECT_EQ(ldr_flip(reference, test).max, 0);
    EXPECT_GT(hdr_flip(reference, test).mean, 0.02);
}

TEST(HdrFlip, KnowsItsToneMappers) {
    const Image reference = of({0.5, 0.4, 0.3}, 16, 16), test = of({0.6, 0.4, 0.3}, 16, 16);
    std::vector<double> means;
    for (const std::string& name : tone_mapper_names()) {
        FlipOptions options;
        options.tone_mapper = *find_tone_mapper(name);
        means.push_back(hdr_flip(reference, test, options).mean);
        EXPECT_GT(means.back(), 0.01) << name;
    }
    EXPECT_NE(means[0], means[1]);
    EXPECT_NE(means[1], means[2]);
    EXPECT_FALSE(find_tone_mapper("ACES2"));
}

}  // namespace
}  // namespace aftershade
