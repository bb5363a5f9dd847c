#include "tests/bench/cache_model.h"

#include <gtest/gtest.h>
#include <cmath>

namespace aftershade::bench {
namespace {

constexpr CacheSize kSmall = {64 << 10, 8};

std::uint64_t misses(const Cache& cache) {
    return cache.reads - cache.hits;
}

TEST(CacheModel, MissesOncePerSectorOfAStream) {
    Cache cache(kSmall);
    constexpr std::uint64_t kBytes = 1 << 20;
    for (std::uint64_t at = 0; at < kBytes; at += 8) cache.access(at);
    EXPECT_EQ(misses(cache), kBytes / kSectorBytes);
}

TEST(CacheModel, HitsAlwaysWhereAllFitsAndNeverWhereACycleIsOneLineTooLong) {
    // One set: fully associative.
    constexpr int kLines = 64;
    for (const int lines : {kLines, kLines + 1}) {
        Cache cache({kLines * kLineBytes, kLines});
        for (int round = 0; round < 10; ++round)
            for (int i = 0; i < lines; ++i) cache.access(std::uint64_t(i) * kLineBytes);
        EXPECT_EQ(misses(cache), std::uint64_t(lines == kLines ? lines : 10 * lines));
    }
}

TEST(CacheModel, KeepsAsManyLinesOfAStrideAsItHasWays) {
    // A stride of the whole cache maps all to one set.
    for (const int lines : {kSmall.ways, kSmall.ways + 1}) {
        Cache cache(kSmall);
        for (int round = 0; round < 10; ++round)
            for (int i = 0; i < lines; ++i) cache.access(std::uint64_t(i) * kSmall.bytes);
        EXPECT_EQ(misses(cache), std::uint64_t(lines == kSmall.ways ? lines : 10 * lines));
    }
}

TEST(CacheModel, HitsRandomReadsByTheShareThatItHolds) {
    // Each line is as likely as another: whatever is kept, it is capacity / working set of them.
    Cache cache(kSmall);
    constexpr std::uint64_t kLines = 4 * (64 << 10) / kLineBytes;
    std::uint64_t state = 1;
    const auto random_line = [&] {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        return (state >> 33) % kLines;
    };
    for (int i = 0; i < 100000; ++i) cache.access(random_line() * kLineBytes);
    cache.reads = cache.hits = 0;
    constexpr int kReads = 400000;
    for (int i = 0; i < kReads; ++i) cache.access(random_line() * kLineBytes);
    const double rate = double(cache.hits) / kReads, sigma = std::sqrt(0.25 * 0.75 / kReads);
    EXPECT_NEAR(rate, 0.25, 5 * sigma);
}

Warp one_fetch(std::uint64_t first, std::uint64_t stride, int count = kLanes) {
    Fetch fetch;
    fetch.count = count;
    for (int i = 0; i < count; ++i) fetch.addresses[std::size_t(i)] = first + stride * std::uint64_t(i);
    return {fetch};
}

TEST(GpuReplay, JoinsWhatTheLanesOfAWarpReadFromOneSector) {
    for (const auto& [stride, sectors] : {std::pair{0, 1}, {4, 4}, {16, 16}, {32, 32}, {4096, 32}}) {
        GpuReplay replay(kTitanXPascal, 1);
        replay.add_block({one_fetch(0, std::uint64_t(stride))});
        replay.finish();
        EXPECT_EQ(replay.counts()[0].sectors, std::uint64_t(sectors)) << stride;
        EXPECT_EQ(replay.counts()[0].texels, 32U);
        EXPECT_EQ(replay.counts()[0].dram_sectors(), std::uint64_t(sectors));
    }
}

TEST(GpuReplay, SharesL2AmongProcessorsButNotL1) {
    GpuReplay replay(kTitanXPascal, 1);
    for (int i = 0; i < kTitanXPascal.processors; ++i) replay.add_block({one_fetch(0, 4)});
    replay.finish();
    const Counts& counts = replay.counts()[0];
    EXPECT_EQ(counts.l1_hits, 0U);
    EXPECT_EQ(counts.dram_sectors(), 4U) << "the first processor's";
    EXPECT_EQ(counts.l2_hits, 4U * unsigned(kTitanXPascal.processors - 1));
}

TEST(GpuReplay, RunsEveryFetchOfEveryWarpOnce) {
    GpuReplay replay(kTitanXPascal, 2);
    std::uint64_t texels[2] = {0, 0};
    for (int block = 0; block < 500; ++block) {
        std::vector<Warp> warps(8);
        for (int w = 0; w < 8; ++w)
            for (int k = 0; k < (block + w) % 7; ++k) {
                Fetch fetch = one_fetch(std::uint64_t(block) * 512, 16, 1 + k)[0];
                fetch.group = w % 2;
                texels[w % 2] += std::uint64_t(fetch.count);
                warps[std::size_t(w)].push_back(fetch);
            }
        replay.add_block(std::move(warps));
    }
    replay.finish();
    for (int g = 0; g < 2; ++g) EXPECT_EQ(replay.counts()[std::size_t(g)].texels, texels[g]);
}

}  // namespace
}  // namespace aftershade::bench
