#include "framework/batch/job_plan.h"

#include <algorithm>
#include <cstdlib>

namespace aftershade {

namespace {

bool is_cut(const JobFrames& run, std::size_t index) {
    return index == 0 || std::find(run.cuts.begin(), run.cuts.end(), run.frames[index]) != run.cuts.end();
}

/// Where the `index`-th of `count` chunks begins, as an index of the run's frames.
std::size_t beginning(const JobFrames& run, int index, int count) {
    const std::size_t size = run.count(), lead = std::size_t(run.lead_frames);
    const std::size_t even = lead + size * std::size_t(index) / std::size_t(count);
    if (!run.has_history || index == 0 || index == count) return even;
    const std::size_t reach = size / std::size_t(count) / 4;
    for (std::size_t away = 0; away <= reach; ++away) {
        if (even + away < run.frames.size() && is_cut(run, even + away)) return even + away;
        if (lead + away <= even && is_cut(run, even - away)) return even - away;
    }
    return even;
}

/// Frames from the beginning of the shot to `index`, at most the run's warm-up.
std::size_t warmup_before(const JobFrames& run, std::size_t index) {
    std::size_t warmup = 0;
    while (run.has_history && warmup < std::size_t(run.warmup_frames) && !is_cut(run, index - warmup))
        ++warmup;
    return warmup;
}

std::vector<JobPiece> dealt(const JobFrames& run, int count) {
    std::vector<JobPiece> pieces(std::size_t(std::min(count, int(run.frames.size()))));
    for (std::size_t i = 0; i < run.frames.size(); ++i)
        pieces[i % pieces.size()].frames.push_back(run.frames[i]);
    return pieces;
}

std::vector<JobPiece> chunks(const JobFrames& run, int count) {
    std::vector<JobPiece> pieces;
    for (int i = 0; i < count; ++i) {
        JobPiece piece = chunk_of(run, i, count);
        if (!piece.frames.empty()) pieces.push_back(std::move(piece));
    }
    return pieces;
}

std::size_t longest(const std::vector<JobPiece>& pieces) {
    std::size_t most = 0;
    for (const JobPiece& piece : pieces) most = std::max(most, piece.frames.size());
    return most;
}

}  // namespace

JobPiece chunk_of(const JobFrames& run, int index, int count) {
    const std::size_t begin = beginning(run, index, count), end = beginning(run, index + 1, count);
    if (begin >= end) return {};
    const std::size_t warmup = warmup_before(run, begin);
    return {{run.frames.begin() + std::ptrdiff_t(begin - warmup), run.frames.begin() + std::ptrdiff_t(end)},
            int(warmup)};
}

std::vector<JobPiece> plan_jobs(const JobFrames& run, int count) {
    if (!run.has_history) return dealt(run, count);
    std::vector<JobPiece> best = chunks(run, 1);
    for (int tried = 2; tried <= count; ++tried) {
        std::vector<JobPiece> pieces = chunks(run, tried);
        if (longest(pieces) < longest(best)) best = std::move(pieces);
    }
    return best;
}

}  // namespace aftershade
