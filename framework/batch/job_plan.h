// Which frames of a run go to which worker, or to which machine of a farm.
#pragma once

#include <cstddef>
#include <vector>

namespace aftershade {

/// Frames for one worker.
struct JobPiece {
    std::vector<int> frames;  ///< in order
    int warmup_frames = 0;    ///< of these, the first ones only warm history up and are not written

    bool operator==(const JobPiece&) const = default;
};

/// A run as far as its division matters.
struct JobFrames {
    std::vector<int> frames;  ///< in the order of the run
    int lead_frames = 0;      ///< of these, the first ones only warm history up, as a chunk's do
    std::vector<int> cuts;    ///< frames that begin a shot, and with it history
    bool has_history = false;
    int warmup_frames = 0;  ///< before a piece that begins within a shot

    std::size_t count() const { return frames.size() - std::size_t(lead_frames); }  ///< of written frames
};

/// The `index`-th of `count` pieces of successive frames, nearly equal in number. With history a piece begins
/// at a cut where one lies within a quarter of its length, else with a warm-up. Empty where there are fewer
/// frames than pieces.
JobPiece chunk_of(const JobFrames& run, int index, int count);

/// At most `count` pieces that workers render at the same time. Without history the frames are dealt in turn,
/// so that the workers end together. With history they are chunks, and only as many as shorten the run: a
/// warm-up may cost more than a worker gains.
std::vector<JobPiece> plan_jobs(const JobFrames& run, int count);

}  // namespace aftershade
