// Reads frames, their sub-frames and their neighbours ahead of the one that is being worked on.
#pragma once

#include <atomic>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/look/object_matches.h"
#include "framework/look/pipeline.h"
#include "framework/look/reach.h"
#include "framework/run/frame_files.h"
#include "framework/run/run_options.h"

namespace aftershade {

/// [one thread at a time; reads on threads of its own]
class FrameLoader {
public:
    using CapturePointer = std::shared_ptr<const Capture>;

    FrameLoader(const Sequence& sequence, const CaptureReader& reader, const Pipeline& pipeline,
                const RunOptions& run, std::vector<RoleId> roles);
    ~FrameLoader();

    /// Whether a file of the `index`-th frame of the run is not there.
    bool is_missing(std::size_t index) const;
    bool can_hold() const { return last_ != nullptr; }
    /// 1, or as many as the sequence has where some effect accumulates them.
    int subframe_count() const { return files_.subframe_count(); }

    /// The frame as take() will give it, as far as its header says: images of roles that will be there are
    /// empty. nullopt where the file cannot be read, or more than one makes the frame.
    std::optional<Capture> outline(std::size_t index) const;
    /// One sub-frame with its neighbours; its number is the frame's. Throws what reading threw.
    CapturePointer take(std::size_t index, int subframe);
    using Neighbours = std::map<int, CapturePointer>;  ///< by offset
    /// Those of the same shot that some input wants and whose files are there.
    Neighbours neighbours(std::size_t index);
    bool begins_shot(std::size_t index) const;
    /// Whether the files of the frame's first sub-frame and of its neighbours are there, so that take() and
    /// neighbours() wait for none of them.
    bool is_read(std::size_t index) const;
    /// RunOptions::frames_ahead, or the number it stands for once a frame is read; 1 before.
    int frames_ahead() const { return frames_ahead_; }
    /// Objects of the look in the frames that were read so far.
    ObjectMatches& objects() { return objects_; }
    /// Time of reading and decoding so far, over all threads.
    double busy_ms() const { return busy_ms_; }

private:
    void request(int file);
    CapturePointer get(int file);
    Capture read(int file) const;
    /// Region, scale and number of the frame.
    void place(Capture& capture, int file) const;
    CapturePointer held(std::size_t index) const;
    void request_next(std::size_t index, std::vector<int>& wanted);

    const Sequence& sequence_;
    const CaptureReader& reader_;
    const Pipeline& pipeline_;
    const RunOptions& run_;
    FrameFiles files_;
    std::vector<RoleId> roles_;
    std::optional<RegionNeeds> region_needs_;
    std::map<int, std::shared_future<CapturePointer>> reads_;  // by file
    CapturePointer last_;
    int frames_ahead_ = 1;
    mutable std::atomic<double> busy_ms_ = 0;
    mutable ObjectMatches objects_;
};

}  // namespace aftershade
