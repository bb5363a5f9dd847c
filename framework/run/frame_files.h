// Which files of a capture each frame of a run reads.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/look/pipeline.h"

namespace aftershade {

/// [thread-safe; refers to what the caller keeps]
class FrameFiles {
public:
    FrameFiles(const Sequence& sequence, const CaptureReader& reader, const Pipeline& pipeline);

    /// 1, or as many as the sequence has where some effect accumulates them.
    int subframe_count() const { return subframes_; }
    /// The number by which the reader reads a sub-frame.
    int number(int frame, int subframe) const;
    /// Whether a file of the frame is not there.
    bool is_missing(int frame) const;
    bool begins_shot(int frame) const;
    /// Whether some input wants the frame `offset` after, and it is of the same shot and there.
    bool has_neighbour(int frame, int offset) const;
    int neighbour_number(int frame, int offset) const { return number(frame + offset, subframes_ / 2); }
    /// The numbers of the sub-frames and of the neighbours.
    std::vector<int> numbers(int frame) const;

    struct Input {
        std::string role;  ///< "main": the file that holds all other roles
        int number = 0;    ///< relative to that of the frame's first sub-frame
        std::filesystem::path path;
    };
    /// Every file that the pixels of the frame may depend on, those that are not there too: the sub-frames',
    /// the neighbours', and where `reads_motion` the file before each sub-frame, whose camera completes
    /// motion vectors.
    std::vector<Input> inputs(int frame, bool reads_motion) const;

private:
    const Sequence& sequence_;
    const CaptureReader& reader_;
    const Pipeline& pipeline_;
    int subframes_ = 1;
};

}  // namespace aftershade
