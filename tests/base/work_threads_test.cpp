#include "framework/base/work_threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <set>
#include <thread>
#include <vector>

namespace aftershade {
namespace {

TEST(WorkThreads, DoEachPieceOnceWhateverTheirNumber) {
    for (const int threads : {1, 2, 7}) {
        WorkThreads work(threads);
        EXPECT_EQ(work.count(), threads);
        for (const int count : {0, 1, 2, 5, 1000}) {
            std::vector<std::atomic<int>> done(static_cast<std::size_t>(count));
            work.run(count, [&](int i) { ++done[std::size_t(i)]; });
            for (const auto& times : done) EXPECT_EQ(times, 1) << threads << " threads, " << count;
        }
    }
}

TEST(WorkThreads, HaveDoneAllWhenRunReturns) {
    WorkThreads work(4);
    std::vector<int> values(64);  // nothing atomic: run() orders the threads' writes
    for (int round = 1; round <= 2000; ++round) {
        work.run(int(values.size()), [&](int i) { values[std::size_t(i)] += i; });
        ASSERT_EQ(std::accumulate(values.begin(), values.end(), 0), round * 64 * 63 / 2);
    }
}

TEST(WorkThreads, WorkAtTheSameTime) {
    WorkThreads work(3);
    std::atomic<int> inside = 0;
    // Each piece waits until all three are worked on.
    work.run(3, [&](int) {
        ++inside;
        while (inside < 3) std::this_thread::yield();
    });
    EXPECT_EQ(inside, 3);
}

}  // namespace
}  // namespace aftershade
