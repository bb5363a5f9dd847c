#include "framework/run/frame_files.h"

#include <algorithm>
#include <set>

namespace aftershade {

FrameFiles::FrameFiles(const Sequence& sequence, const CaptureReader& reader, const Pipeline& pipeline)
    : sequence_(sequence), reader_(reader), pipeline_(pipeline) {
    if (pipeline.last_accumulating_step() >= 0) subframes_ = sequence.subframes;
}

int FrameFiles::number(int frame, int subframe) const {
    // Where nothing accumulates, the middle of the exposure stands for the frame.
    const bool alone = subframes_ < sequence_.subframes;
    return sequence_.file_number(frame, alone ? sequence_.subframes / 2 : subframe);
}

bool FrameFiles::is_missing(int frame) const {
    for (int subframe = 0; subframe < subframes_; ++subframe)
        if (!reader_.has_frame(number(frame, subframe))) return true;
    return false;
}

bool FrameFiles::begins_shot(int frame) const {
    return std::find(sequence_.cuts.begin(), sequence_.cuts.end(), frame) != sequence_.cuts.end();
}

bool FrameFiles::has_neighbour(int frame, int offset) const {
    if (pipeline_.neighbour_roles(offset).empty()) return false;
    for (int later = std::min(frame, frame + offset) + 1; later <= std::max(frame, frame + offset); ++later)
        if (begins_shot(later)) return false;
    return reader_.has_frame(neighbour_number(frame, offset));
}

std::vector<int> FrameFiles::numbers(int frame) const {
    std::vector<int> files;
    for (int subframe = 0; subframe < subframes_; ++subframe) files.push_back(number(frame, subframe));
    for (const int offset : pipeline_.neighbour_offsets())
        if (has_neighbour(frame, offset)) files.push_back(neighbour_number(frame, offset));
    return files;
}

std::vector<FrameFiles::Input> FrameFiles::inputs(int frame, bool reads_motion) const {
    const std::vector<int> read = numbers(frame);
    std::set<int> all(read.begin(), read.end());
    if (reads_motion && sequence_.files.has_frame())
        for (const int file : read) all.insert(file - sequence_.subframes);
    if (begins_shot(frame)) all.erase(all.begin(), all.lower_bound(number(frame, 0)));
    std::vector<Input> inputs;
    const int first = sequence_.file_number(frame);
    for (const int file : all) {
        const auto add = [&](const Sequence& sequence, const std::string& prefix) {
            inputs.push_back({prefix + "main", file - first, sequence.path_of(file)});
            for (const auto& [role, pattern] : sequence.role_files)
                inputs.push_back({prefix + role, file - first, pattern.path(file)});
        };
        if (sequence_.layers.empty()) add(sequence_, "");
        for (std::size_t i = 0; i < sequence_.layers.size(); ++i)
            add(sequence_of_layer(sequence_, i), "layer " + std::to_string(i) + " ");
    }
    return inputs;
}

}  // namespace aftershade
