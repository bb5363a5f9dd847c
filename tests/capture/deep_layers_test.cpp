#include "framework/capture/deep_layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "tests/capture/deep_twin.h"

namespace aftershade::test {
namespace {

/// The program's answer for one pixel.
struct ReducedPixel {
    explicit ReducedPixel(const std::vector<OneSample>& samples, int count) {
        for (const OneSample& sample : samples) {
            front.push_back(float(sample.front));
            back.push_back(float(sample.back));
            alpha.push_back(float(sample.alpha));
            values.push_back(float(sample.value));
        }
        first = {0, std::uint32_t(samples.size())};
        layers.emplace(DeepGeometry{first, front, back, alpha}, count);
    }
    float value(int layer) const { return layers->blended(values, 0, layer); }
    float alpha_of(int layer) const { return layers->alpha(0, layer); }
    std::vector<std::uint32_t> first;
    std::vector<float> front, back, alpha, values;
    std::optional<DeepLayers> layers;
};

TEST(DeepLayers, PutSortedSamplesOverOneAnother) {
    const ReducedPixel one({{3, 3, 1, 0.7}, {1, 1, 0.5, 0.2}, {2, 2, 0.25, 0.1}}, 1);
    EXPECT_NEAR(one.value(-1), 0.2 + 0.5 * (0.1 + 0.75 * 0.7), 1e-6);
    EXPECT_NEAR(one.alpha_of(-1), 1, 1e-6);
    EXPECT_EQ(one.layers->shown(0, -1), 1u);  // half of the pixel; the wall shows through 0.375
}

TEST(DeepLayers, AreSplitAtGapsAndGiveTheFlatPictureAgain) {
    const std::vector<OneSample> samples = {
        {1, 1, 0.5, 0.2}, {1.004, 1.004, 0.5, 0.3}, {8, 8, 1, 0.7}, {9, 9, 1, 0.9}};
    const ReducedPixel four(samples, 4);
    EXPECT_NEAR(four.value(0), 0.2 + 0.5 * 0.3, 1e-6);
    EXPECT_NEAR(four.alpha_of(0), 0.75, 1e-6);
    EXPECT_NEAR(four.value(1), 0.7, 1e-6);
    EXPECT_NEAR(four.value(2), 0.9, 1e-6);  // hidden, and yet there
    EXPECT_EQ(four.alpha_of(3), 0);
    EXPECT_EQ(four.layers->shown(0, 3), DeepLayers::kNoSample);
    EXPECT_NEAR(four.value(-1), 0.35 + 0.25 * 0.7, 1e-6);
    EXPECT_EQ(four.layers->reduction().merged_pixels, 0u);
    EXPECT_LT(four.layers->reduction().most_shift, 0.004);
}

TEST(DeepLayers, PutTogetherWhatMovesTheLeastLightWhereThereAreTooMany) {
    const std::vector<OneSample> samples = {{1, 1, 0.5, 1}, {1.2, 1.2, 0.5, 1}, {4, 4, 0.5, 1}, {5, 5, 1, 1}};
    const ReducedPixel two(samples, 2);
    EXPECT_NEAR(two.alpha_of(0), 0.75, 1e-6);
    EXPECT_NEAR(two.alpha_of(1), 1, 1e-6);
    EXPECT_EQ(two.layers->reduction().merged_pixels, 1u);
    // A third of the front's alpha lies at 1.2 instead of 1, and half of the back's at 5 instead of 4.
    EXPECT_NEAR(two.layers->reduction().mean_shift, (0.25 * std::log(1.2) + 0.5 * std::log(1.25)) / 1.75,
                1e-6);
}

TEST(DeepLayers, KeepWhatIsNextBehindTheFrontBesideASkyThatIsInfinitelyFar) {
    const double sky = std::numeric_limits<double>::infinity();
    for (const double alpha : {0.375, 1.0}) {
        const ReducedPixel two({{8, 8, alpha, alpha}, {15, 15, 1, 0.5}, {sky, sky, 1, 0.25}}, 2);
        EXPECT_NEAR(two.alpha_of(0), alpha, 1e-6);
        EXPECT_NEAR(two.value(1), 0.5, 1e-6);
        EXPECT_EQ(two.layers->shown(0, 1), 1u);
    }
}

TEST(DeepLayers, MixWhatOverlapsAsKainzSays) {
    std::mt19937 random(7);
    const auto unit = [&] { return double(random() % 1000) / 1000; };
    for (int turn = 0; turn < 500; ++turn) {
        std::vector<OneSample> samples;
        const int count = 1 + int(random() % 7);
        for (int i = 0; i < count; ++i) {
            OneSample sample;
            sample.front = 1 + double(random() % 5) / 4;
            sample.back = random() % 3 == 0 ? sample.front : sample.front + 0.25 * double(1 + random() % 4);
            sample.alpha = random() % 8 == 0 ? 0 : random() % 8 == 0 ? 1 : unit();
            sample.value = unit();
            samples.push_back(sample);
        }
        double alpha = 0;
        const double value = Kainz::value_in_front(samples, alpha);
        for (const int layers : {1, 4}) {
            const ReducedPixel reduced(samples, layers);
            ASSERT_NEAR(reduced.value(-1), value, 1e-5) << turn;
            ASSERT_NEAR(reduced.alpha_of(-1), alpha, 1e-5) << turn;
        }
    }
}

TEST(DeepLayers, AtOneDepthAreMergedAndNotPutOverOneAnother) {
    for (const double back : {1.0, 2.0}) {
        const ReducedPixel translucent({{1, back, 0.5, 0.5}, {1, back, 0.75, 0}}, 1);
        // Thickness ln 2 beside ln 4: of what is seen, a third is of the first.
        EXPECT_NEAR(translucent.value(-1), (1 - 0.5 * 0.25) / 3, 1e-6) << back;
        const ReducedPixel walls({{1, back, 1, 0.2}, {1, back, 0.5, 0.5}, {1, back, 1, 0.6}}, 1);
        EXPECT_NEAR(walls.value(-1), 0.4, 1e-6) << back;
    }
}

TEST(DeepLayers, TakeWhateverNumbersAFileHolds) {
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    const ReducedPixel odd({{nan, 1, nan, 0.5},
                            {-3, -2, 2, 0.25},
                            {0, 0, -1, 1},
                            {infinity, infinity, 1, 0.125},
                            {2, 1, 0.5, 0.5},
                            {1, infinity, 0.5, 0.5}},
                           4);
    for (int layer = -1; layer < 4; ++layer) {
        EXPECT_TRUE(std::isfinite(odd.value(layer))) << layer;
        EXPECT_GE(odd.alpha_of(layer), 0) << layer;
        EXPECT_LE(odd.alpha_of(layer), 1) << layer;
    }
    EXPECT_EQ(odd.alpha_of(-1), 1);
}

TEST(DeepLayers, OfManyVolumesInOnePixelTakeNoTime) {
    std::vector<OneSample> samples;
    for (int i = 0; i < 100'000; ++i) samples.push_back({1 + i * 1e-5, 3 + i * 1e-5, 1e-5, 1e-5});
    const ReducedPixel reduced(samples, 4);
    EXPECT_NEAR(reduced.alpha_of(-1), 1 - std::pow(1 - 1e-5, 1e5), 1e-4);
    std::vector<OneSample> apart;
    for (int i = 0; i < 20'000; ++i) apart.push_back({1 + 0.05 * i, 1 + 0.05 * i, 0.5, 0.5});
    EXPECT_NEAR(ReducedPixel(apart, 4).value(-1), 1, 1e-6);
}

}  // namespace
}  // namespace aftershade::test
