#include "framework/compare/pixel_differences.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/compare/pictures.h"

namespace aftershade {
namespace {

using test::constant;
using test::ids;
using test::kInfinity;
using test::kNan;
using test::row;

PixelDifferences differences(const Image& reference, const Image& test, LayerRole role = LayerRole::data,
                             const DifferenceRules& rules = {}) {
    return pixel_differences(reference, test, role, rules);
}

TEST(PixelDifferences, OfAnImageAndItselfAreNone) {
    const Image image =
        test::picture(13, 7, 3, [](int x, int y, int c) { return test::hashed(x, y, c, 1) * 9; });
    const PixelDifferences d = differences(image, image);
    EXPECT_EQ(d.pixels, 13 * 7);
    EXPECT_TRUE(d.bits_equal);
    EXPECT_EQ(d.largest.value, 0);
    EXPECT_EQ(d.rmse, 0);
    EXPECT_EQ(d.failing.count, 0);
    EXPECT_EQ(d.psnr_db, std::numeric_limits<double>::infinity());
}

TEST(PixelDifferences, OfConstantsFollowTheirDefinitions) {
    const PixelDifferences d = differences(constant(4, 3, {0.5f, 0.5f}), constant(4, 3, {0.75f, 0.25f}));
    EXPECT_DOUBLE_EQ(d.mean_absolute, 0.25);
    EXPECT_DOUBLE_EQ(d.rmse, 0.25);
    EXPECT_DOUBLE_EQ(d.psnr_peak, 0.5);
    EXPECT_DOUBLE_EQ(d.psnr_db, 20 * std::log10(0.5 / 0.25));
    EXPECT_DOUBLE_EQ(d.relative_mse, 0.0625 / (0.25 + 0.01));
    EXPECT_EQ(d.values, 4 * 3 * 2);
}

TEST(PixelDifferences, HaveThePeakOneOfEncodedColoursAndTheReferencesLargestElsewhere) {
    const Image reference = row({0.25f, -8}), test = row({0.25f, -7});
    EXPECT_EQ(differences(reference, test, LayerRole::display).psnr_peak, 1);
    EXPECT_EQ(differences(reference, test, LayerRole::color).psnr_peak, 8);
    EXPECT_EQ(differences(row({0, 0}), row({0, 1})).psnr_peak, 1);
}

TEST(PixelDifferences, TellTheLargestWithItsPlaceChannelAndValues) {
    Image reference(5, 4, 3), test(5, 4, 3);
    reference.at(3, 2, 1) = 2;
    test.at(3, 2, 1) = -7;
    const LargestDifference largest = differences(reference, test).largest;
    EXPECT_EQ(largest.value, 9);
    EXPECT_EQ(largest.x, 3);
    EXPECT_EQ(largest.y, 2);
    EXPECT_EQ(largest.channel, 1);
    EXPECT_EQ(largest.reference, 2);
    EXPECT_EQ(largest.test, -7);
}

TEST(PixelDifferences, CountAPixelOnceHoweverManyChannelsFail) {
    const PixelDifferences d = differences(constant(6, 5, {0, 0, 0}), constant(6, 5, {1, 1, 1}));
    EXPECT_EQ(d.failing.count, 30);
}

TEST(PixelDifferences, BoxTheFailingPixels) {
    Image reference(9, 8, 1), test(9, 8, 1);
    test.at(2, 6, 0) = 1;
    test.at(7, 1, 0) = 1;
    const FailingPixels failing = differences(reference, test).failing;
    EXPECT_EQ(failing.count, 2);
    EXPECT_EQ(failing.box, (Window{2, 1, 7, 6}));
    EXPECT_EQ(differences(reference, reference).failing.box.width(), 0);
}

TEST(PixelDifferences, FailAboveTheLimitAndNotAtIt) {
    DifferenceRules rules;
    rules.fail = 0.25;
    rules.hard_fail = 0.5;
    const PixelDifferences d =
        differences(row({0, 0, 0, 0}), row({0.25f, 0.375f, 0.5f, 0.625f}), LayerRole::data, rules);
    EXPECT_EQ(d.failing.count, 3);
    EXPECT_EQ(d.hard_failing.count, 1);
}

TEST(PixelDifferences, FailOnlyWhereARelativeLimitIsExceededTooAsIdiffSays) {
    struct Case {
        float reference, test;
        double fail, relative;
        std::uint64_t failing;  ///< by idiff 2.4.7's exit code
    };
    for (const Case& c : {Case{98, 98.0625f, 0.004, 0, 1},
                          {98, 98.0625f, 0.004, 0.001, 0},
                          {98, 98.0625f, 0.004, 0.0005, 1},
                          {98, 98.0625f, 0.1, 0.0005, 0},
                          {0.5f, 0.51f, 0.004, 0.001, 1},
                          {0.5f, 0.51f, 0.004, 0.03, 0},
                          {0.5f, 0.51f, 0.004, 0.015, 1}}) {
        DifferenceRules rules;
        rules.fail = rules.warn = c.fail, rules.fail_relative = c.relative, rules.hard_fail = 1e-3;
        // A channel beside it that differs by less than either limit changes nothing.
        const PixelDifferences d = differences(constant(1, 1, {c.reference, 7}), constant(1, 1, {c.test, 7}),
                                               LayerRole::color, rules);
        EXPECT_EQ(d.failing.count, c.failing) << c.reference << " " << c.fail << " " << c.relative;
        EXPECT_EQ(d.warning.count, c.reference > 1 ? c.fail < 0.0625 : c.fail < 0.01);
        EXPECT_EQ(d.hard_failing.count, 1) << "no relative limit holds for hard_fail";
        EXPECT_NEAR(d.largest_pixel, std::abs(c.test - c.reference), 1e-7);
    }
}

TEST(PixelDifferences, HoldARelativeLimitOfAVectorByItsLength) {
    DifferenceRules rules;
    rules.fail_relative = 0.1;
    const auto failing = [&](std::vector<float> reference, std::vector<float> test) {
        return differences(constant(1, 1, std::move(reference)), constant(1, 1, std::move(test)),
                           LayerRole::velocity, rules)
            .failing.count;
    };
    EXPECT_EQ(failing({30, 40}, {30, 44}), 0) << "4 px of about 51";
    EXPECT_EQ(failing({30, 40}, {30, 46}), 1) << "6 px of about 52";
    EXPECT_EQ(failing({0, 0}, {0, 0.5f}), 1);
    EXPECT_EQ(failing({30, 40, 1, 0}, {30, 44, 2, 0}), 1) << "the second vector's";
}

TEST(PixelDifferences, LetUnitsInTheLastPlaceOfTheStoredTypePassAtEveryValue) {
    // A half has 10 bits below its first: 4 at 5464, 0.125 at 140, 2^-24 below 2^-14.
    struct Case {
        float reference, test;
        double units;
    };
    for (const Case& c : {Case{5464, 5468, 1},
                          {140.25f, 140.375f, 1},
                          {2047, 2049, 1},
                          {-0.75f, -0.7509765625f, 2},
                          {0, 0x1p-24f, 1},
                          {0x1p-15f, 0x1p-15f + 3 * 0x1p-24f, 3}})
        for (const LayerRole role : {LayerRole::color, LayerRole::data, LayerRole::depth}) {
            DifferenceRules rules;
            rules.fail = rules.hard_fail = 0, rules.stored = kStoredHalf;
            const auto failing = [&](double ulp) {
                rules.fail_ulp = ulp;
                const PixelDifferences d = differences(row({c.reference}), row({c.test}), role, rules);
                EXPECT_EQ(d.failing.count, d.hard_failing.count);
                return d.failing.count;
            };
            EXPECT_EQ(failing(c.units), 0) << c.reference << " " << c.test;
            EXPECT_EQ(failing(c.units * 0.99), 1) << c.reference << " " << c.test;
            rules.stored = {};
            EXPECT_EQ(failing(c.units), 1) << "a float's are smaller";
        }
}

TEST(PixelDifferences, NeverLetUnitsInTheLastPlacePassIdsInfinityOrNan) {
    DifferenceRules rules;
    rules.fail_ulp = 1e9, rules.stored = kStoredHalf;
    for (const auto& [r, t] : {std::pair{kInfinity, 1.0f}, {1.0f, -kInfinity}, {kNan, 1.0f}})
        for (const LayerRole role : {LayerRole::data, LayerRole::velocity, LayerRole::depth})
            EXPECT_EQ(differences(row({r}), row({t}), role, rules).failing.count, 1) << r << " " << t;
    EXPECT_EQ(differences(row({3}), row({4}), LayerRole::id, rules).failing.count, 1);
}

TEST(PixelDifferences, NeverLetARelativeLimitPassInfinityOrNan) {
    DifferenceRules rules;
    rules.fail_relative = 10;
    for (const auto& [r, t] : {std::pair{kInfinity, 1.0f}, {1.0f, -kInfinity}, {kNan, 1.0f}})
        for (const LayerRole role : {LayerRole::data, LayerRole::velocity})
            EXPECT_EQ(differences(row({r}), row({t}), role, rules).failing.count, 1) << r << " " << t;
}

TEST(PixelDifferences, TakeNanForEqualOnlyWhenAsked) {
    DifferenceRules rules;
    PixelDifferences d = differences(row({kNan, 1}), row({kNan, 1}), LayerRole::data, rules);
    EXPECT_EQ(d.failing.count, 1);
    EXPECT_EQ(d.incomparable, 1);
    EXPECT_EQ(d.largest.value, kInfinity);
    rules.nan_equal = true;
    d = differences(row({kNan, 1}), row({kNan, 1}), LayerRole::data, rules);
    EXPECT_EQ(d.failing.count, 0);
    EXPECT_EQ(d.reference_counts, (NonFiniteCounts{1, 0}));
}

TEST(PixelDifferences, NeverTakeNanForANumberWhateverTheLimit) {
    DifferenceRules rules;
    rules.fail = std::numeric_limits<double>::infinity();
    rules.nan_equal = true;
    for (const auto& [r, t] :
         {std::pair{kNan, 1.0f}, {1.0f, kNan}, {kInfinity, 1.0f}, {kInfinity, -kInfinity}, {kNan, kInfinity}})
        EXPECT_EQ(differences(row({r}), row({t}), LayerRole::data, rules).failing.count, 1) << r << " " << t;
    EXPECT_EQ(differences(row({kInfinity, -kInfinity}), row({kInfinity, -kInfinity})).failing.count, 0);
}

TEST(PixelDifferences, TakeMeansOverWhatIsFiniteInBoth) {
    const PixelDifferences d = differences(row({kNan, 1, 1, kInfinity}), row({0, 2, 1, 5}));
    EXPECT_EQ(d.values, 2);
    EXPECT_EQ(d.incomparable, 2);
    EXPECT_DOUBLE_EQ(d.mean_absolute, 0.5);
    EXPECT_DOUBLE_EQ(d.rmse, std::sqrt(0.5));
    EXPECT_EQ(d.reference_counts, (NonFiniteCounts{1, 1}));
    EXPECT_EQ(d.test_counts, (NonFiniteCounts{0, 0}));
}

TEST(PixelDifferences, HaveNoPsnrWhereOnlyWhatCannotBeComparedDiffers) {
    EXPECT_TRUE(std::isnan(differences(row({1, 2}), row({1, kNan})).psnr_db))
        << "infinite is of equal images";
    EXPECT_TRUE(std::isfinite(differences(row({1, 2, 3}), row({1, kNan, 4})).psnr_db));
}

TEST(PixelDifferences, OfDepthAreRelativeToTheReference) {
    DifferenceRules rules;
    rules.fail = 0.015;
    const PixelDifferences d =
        differences(row({100, 1, kInfinity, 0}), row({101, 1.02f, kInfinity, 0}), LayerRole::depth, rules);
    EXPECT_EQ(d.failing.count, 1) << "one per cent at 100 m passes, two at 1 m do not";
    EXPECT_NEAR(d.largest_pixel, 0.02, 1e-6);
    EXPECT_EQ(d.largest.value, 1) << "the absolute error is still told";
    EXPECT_EQ(differences(row({kInfinity}), row({100}), LayerRole::depth, rules).failing.count, 1);
    EXPECT_EQ(differences(row({0}), row({1e-9f}), LayerRole::depth, rules).largest_pixel, kInfinity);
}

TEST(PixelDifferences, OfVelocityAreEndPointErrors) {
    DifferenceRules rules;
    rules.fail = 4.5;
    const PixelDifferences d =
        differences(constant(2, 2, {1, 1}), constant(2, 2, {4, 5}), LayerRole::velocity, rules);
    EXPECT_DOUBLE_EQ(d.largest_pixel, 5);
    EXPECT_DOUBLE_EQ(d.mean_pixel, 5);
    EXPECT_EQ(d.failing.count, 4) << "no channel differs by more than 4.5, the vectors do";
    EXPECT_EQ(
        differences(constant(2, 2, {1, 1}), constant(2, 2, {4, 5}), LayerRole::data, rules).failing.count, 0);
}

TEST(PixelDifferences, OfFourChannelsOfVelocityAreThoseOfTheWorseVector) {
    const PixelDifferences d =
        differences(constant(1, 1, {0, 0, 0, 0}), constant(1, 1, {3, 4, 6, 8}), LayerRole::velocity);
    EXPECT_DOUBLE_EQ(d.largest_pixel, 10);
}

TEST(PixelDifferences, OfIdsAreAllOrNothing) {
    DifferenceRules rules;
    rules.fail = 1000;
    const PixelDifferences d =
        differences(ids({1, 2, 4000000001u, 7}), ids({1, 3, 4000000000u, 7}), LayerRole::id, rules);
    EXPECT_EQ(d.failing.count, 2) << "neighbouring ids are other objects";
    EXPECT_EQ(d.largest.x, 1);
    EXPECT_EQ(d.largest.reference, 2);
    EXPECT_EQ(d.largest.test, 3);
}

TEST(PixelDifferences, OfFloatIdsCompareBits) {
    const Image nan_id = row({kNan});
    EXPECT_EQ(differences(nan_id, nan_id, LayerRole::id).failing.count, 0) << "Cryptomatte hashes may be NaN";
    EXPECT_EQ(differences(row({0.0f}), row({-0.0f}), LayerRole::id).failing.count, 1);
    EXPECT_EQ(differences(row({1e-40f}), row({2e-40f}), LayerRole::id).failing.count, 1);
}

TEST(PixelDifferences, AreTheSameOnAnyNumberOfThreads) {
    const auto noise = [](int seed) {
        return test::picture(67, 129, 3, [=](int x, int y, int c) { return test::hashed(x, y, c, seed); });
    };
    const Image reference = noise(1), test = noise(2);
    const PixelDifferences one = pixel_differences(reference, test, LayerRole::color, {}, 1);
    for (const int threads : {2, 3, 8}) {
        const PixelDifferences more = pixel_differences(reference, test, LayerRole::color, {}, threads);
        EXPECT_EQ(one.rmse, more.rmse);
        EXPECT_EQ(one.mean_absolute, more.mean_absolute);
        EXPECT_EQ(one.relative_mse, more.relative_mse);
        EXPECT_EQ(one.largest.x, more.largest.x);
        EXPECT_EQ(one.largest.y, more.largest.y);
    }
}

}  // namespace
}  // namespace aftershade
