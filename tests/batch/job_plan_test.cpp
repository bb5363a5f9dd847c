#include "framework/batch/job_plan.h"

#include <gtest/gtest.h>

#include <numeric>

namespace aftershade {
namespace {

JobFrames frames(int count) {
    JobFrames run;
    run.frames.resize(std::size_t(count));
    std::iota(run.frames.begin(), run.frames.end(), 1);
    return run;
}

JobFrames with_history(int count, int warmup_frames, std::vector<int> cuts = {}) {
    JobFrames run = frames(count);
    run.has_history = true;
    run.warmup_frames = warmup_frames;
    run.cuts = std::move(cuts);
    return run;
}

/// The frames that the pieces write, in their order.
std::vector<int> written(const std::vector<JobPiece>& pieces) {
    std::vector<int> all;
    for (const JobPiece& piece : pieces)
        all.insert(all.end(), piece.frames.begin() + piece.warmup_frames, piece.frames.end());
    return all;
}

TEST(JobPlan, DealsFramesWithoutHistoryInTurn) {
    const auto pieces = plan_jobs(frames(7), 3);
    ASSERT_EQ(pieces.size(), 3u);
    EXPECT_EQ(pieces[0].frames, (std::vector<int>{1, 4, 7}));
    EXPECT_EQ(pieces[2].frames, (std::vector<int>{3, 6}));
    EXPECT_EQ(plan_jobs(frames(2), 8).size(), 2u);
}

TEST(JobPlan, CutsFramesWithHistoryAndWarmsUp) {
    const auto pieces = plan_jobs(with_history(48, 4), 4);
    ASSERT_EQ(pieces.size(), 4u);
    EXPECT_EQ(pieces[0].warmup_frames, 0);
    EXPECT_EQ(pieces[1].warmup_frames, 4);
    EXPECT_EQ(pieces[1].frames.front(), 9);
    EXPECT_EQ(written(pieces), frames(48).frames);
}

TEST(JobPlan, BeginsAChunkAtANearCutWithoutWarmup) {
    const auto pieces = plan_jobs(with_history(48, 10, {27}), 2);
    ASSERT_EQ(pieces.size(), 2u);
    EXPECT_EQ(pieces[1].frames.front(), 27);
    EXPECT_EQ(pieces[1].warmup_frames, 0);
    EXPECT_EQ(written(pieces), frames(48).frames);
}

TEST(JobPlan, WarmsUpNoFurtherThanTheBeginningOfTheShot) {
    const JobPiece piece = chunk_of(with_history(48, 10, {20}), 1, 2);
    EXPECT_EQ(piece.frames.front(), 20) << "chunk 2 of 2 begins at the cut";
    const JobPiece third = chunk_of(with_history(90, 10, {25}), 1, 3);
    EXPECT_EQ(third.frames.front(), 25);
    const JobPiece far = chunk_of(with_history(400, 10, {295}), 3, 4);
    EXPECT_EQ(far.frames[std::size_t(far.warmup_frames)], 295);
}

TEST(JobPlan, UsesNoWorkersThatWarmupWouldCostMoreThanTheyGain) {
    EXPECT_EQ(plan_jobs(with_history(20, 64), 8).size(), 1u);
    const auto pieces = plan_jobs(with_history(300, 64), 8);
    std::size_t longest = 0;
    for (const JobPiece& piece : pieces) longest = std::max(longest, piece.frames.size());
    EXPECT_LT(longest, 300u);
    EXPECT_EQ(written(pieces), frames(300).frames);
}

TEST(JobPlan, AChunkIsDividedWithItsOwnWarmup) {
    const JobPiece chunk = chunk_of(with_history(96, 4), 1, 2);
    JobFrames run = with_history(0, 4);
    run.frames = chunk.frames;
    run.lead_frames = chunk.warmup_frames;
    const auto pieces = plan_jobs(run, 2);
    ASSERT_EQ(pieces.size(), 2u);
    EXPECT_EQ(pieces[0].frames.front(), 45);
    EXPECT_EQ(pieces[0].warmup_frames, 4);
    EXPECT_EQ(pieces[1].frames[std::size_t(pieces[1].warmup_frames)], 73);
    EXPECT_EQ(written(pieces).front(), 49);
    EXPECT_EQ(written(pieces).size(), 48u);
}

TEST(JobPlan, ChunksOfAllCountsHoldEveryFrameOnce) {
    for (int size = 1; size <= 40; size += 3)
        for (int count = 1; count <= 12; ++count) {
            std::vector<JobPiece> pieces;
            for (int i = 0; i < count; ++i) {
                const JobPiece piece = chunk_of(with_history(size, 3, {5, 17}), i, count);
                if (!piece.frames.empty()) pieces.push_back(piece);
            }
            EXPECT_EQ(written(pieces), frames(size).frames) << size << " in " << count;
        }
}

}  // namespace
}  // namespace aftershade
