#include "framework/base/parallel.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <numeric>
#include <vector>

namespace aftershade {
namespace {

TEST(PartsForThreads, FollowEachOtherAtMultiplesOfTheStepToTheEnd) {
    constexpr std::size_t kStep = 1920;
    for (const std::size_t count : {kStep * 1080 * 4, kStep * 1080 + 7})
        for (const int threads : {1, 2, 3, 8}) {
            const std::vector<Part> parts = parts_for_threads(count, kStep, threads);
            std::size_t at = 0;
            for (const Part& part : parts) {
                EXPECT_EQ(part.begin, at);
                EXPECT_EQ(part.begin % kStep, 0u);
                EXPECT_LT(part.begin, part.end);
                at = part.end;
            }
            EXPECT_EQ(at, count) << threads;
            EXPECT_LE(parts.size(), std::size_t(threads));
        }
    EXPECT_EQ(parts_for_threads(kStep * 1080, kStep, 4).size(), 4u);
}

TEST(PartsForThreads, AreOneWhereThereIsLittleToDo) {
    EXPECT_EQ(parts_for_threads(1000, 1, 16).size(), 1u);
    const std::vector<Part> none = parts_for_threads(0, 1024, 4);
    ASSERT_EQ(none.size(), 1u);
    EXPECT_EQ(none.front().end, 0u);
}

TEST(ForEachPart, ReturnsWhatEachPartMadeInTheirOrder) {
    constexpr std::size_t kCount = 4'000'000;
    const auto sums = for_each_part(parts_for_threads(kCount, 1000, 4), [](const Part& part) {
        std::size_t sum = 0;
        for (std::size_t i = part.begin; i < part.end; ++i) sum += i;
        return sum;
    });
    ASSERT_EQ(sums.size(), 4u);
    EXPECT_LT(sums[0], sums[1]);
    EXPECT_LT(sums[2], sums[3]);
    EXPECT_EQ(std::accumulate(sums.begin(), sums.end(), std::size_t(0)), kCount * (kCount - 1) / 2);
}

}  // namespace
}  // namespace aftershade
