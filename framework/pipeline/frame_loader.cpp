#include "framework/pipeline/frame_loader.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "framework/capture/capture_window.h"
#include "framework/pipeline/nan_policy.h"

namespace aftershade {

namespace {

void add_missing(std::vector<std::string>& list, const std::vector<std::string>& items) {
    for (const std::string& item : items)
        if (std::find(list.begin(), list.end(), item) == list.end()) list.push_back(item);
}

/// The region of the display window at full scale, with its margin, in the coordinates of the windows.
Window region_with_margin(const RunOptions& run, const Window& display) {
    const Window& region = *run.region;
    const int margin = run.region_margin_px;
    return {display.min_x + region.min_x - margin, display.min_y + region.min_y - margin,
            display.min_x + region.max_x + margin, display.min_y + region.max_y + margin};
}

/// Adds how long it lived.
class BusyTime {
public:
    explicit BusyTime(std::atomic<double>& sum_ms) : sum_ms_(sum_ms), start_(Trace::Clock::now()) {}
    ~BusyTime() {
        sum_ms_ += std::chrono::duration<double, std::milli>(Trace::Clock::now() - start_).count();
    }
    BusyTime(const BusyTime&) = delete;
    BusyTime& operator=(const BusyTime&) = delete;

private:
    std::atomic<double>& sum_ms_;
    Trace::Clock::time_point start_;
};

}  // namespace

FrameLoader::FrameLoader(const Sequence& sequence, const CaptureReader& reader, const Pipeline& pipeline,
                         const RunOptions& run, std::vector<std::string> roles)
    : sequence_(sequence), reader_(reader), pipeline_(pipeline), run_(run), roles_(std::move(roles)) {
    if (pipeline.last_accumulating_step() >= 0) subframes_ = sequence.subframes;
    for (const int offset : {-1, 1}) add_missing(roles_, pipeline.neighbour_roles(offset));
    if (!run.frames.empty() && !is_missing(0))
        for (const int file : files_of(0)) request(file);
}

FrameLoader::~FrameLoader() {
    for (const auto& [file, read] : reads_) read.wait();
}

int FrameLoader::file_of(int frame, int subframe) const {
    // Where nothing accumulates, the middle of the exposure stands for the frame.
    const bool alone = subframes_ < sequence_.subframes;
    return sequence_.file_number(frame, alone ? sequence_.subframes / 2 : subframe);
}

bool FrameLoader::is_missing(std::size_t index) const {
    for (int subframe = 0; subframe < subframes_; ++subframe)
        if (!reader_.has_frame(file_of(run_.frames[index], subframe))) return true;
    return false;
}

bool FrameLoader::is_cut(int frame) const {
    return std::find(sequence_.cuts.begin(), sequence_.cuts.end(), frame) != sequence_.cuts.end();
}

bool FrameLoader::begins_shot(std::size_t index) const {
    return is_cut(run_.frames[index]);
}

bool FrameLoader::has_neighbour(int frame, int offset) const {
    if (pipeline_.neighbour_roles(offset).empty() || is_cut(offset < 0 ? frame : frame + 1)) return false;
    return reader_.has_frame(file_of(frame + offset, subframes_ / 2));
}

std::vector<int> FrameLoader::files_of(std::size_t index) const {
    std::vector<int> files;
    const int frame = run_.frames[index];
    for (int subframe = 0; subframe < subframes_; ++subframe) files.push_back(file_of(frame, subframe));
    for (const int offset : {-1, 1})
        if (has_neighbour(frame, offset)) files.push_back(file_of(frame + offset, subframes_ / 2));
    return files;
}

Capture FrameLoader::read(int file) const {
    const BusyTime busy(busy_ms_);
    const TraceScope traced(run_.trace, "decode", "file " + std::to_string(file));
    Capture capture = reader_.read(file, roles_);
    require_capture_roles(pipeline_, capture.header);
    apply_nan_policy(run_.on_nan, capture);  // before scaling, which spreads NaN
    if (run_.region) crop_capture(capture, region_with_margin(run_, capture.header.display_window));
    scale_capture(capture, run_.scale_divisor);
    const int subframe = (file % sequence_.subframes + sequence_.subframes) % sequence_.subframes;
    capture.header.frame = (file - subframe) / sequence_.subframes;
    return capture;
}

void FrameLoader::request(int file) {
    if (reads_.contains(file)) return;
    reads_[file] = std::async(std::launch::async, [this, file]() -> CapturePointer {
                       return std::make_shared<const Capture>(read(file));
                   }).share();
}

FrameLoader::CapturePointer FrameLoader::get(int file) {
    request(file);
    return reads_.at(file).get();
}

FrameLoader::CapturePointer FrameLoader::held(std::size_t index) const {
    auto held = std::make_shared<Capture>(*last_);
    held->header.frame = run_.frames[index];
    return held;
}

FrameLoader::CapturePointer FrameLoader::take(std::size_t index, int subframe) {
    const int file = file_of(run_.frames[index], subframe);
    const bool holds = is_missing(index) && run_.missing == MissingFrame::hold && last_;
    const bool last_of_frame = subframe + 1 == subframes_;
    if (!holds) {
        request(file);
        reads_.at(file).wait();
    }
    // What comes next is read while this one is worked on; what no longer matters is let go.
    std::vector<int> wanted = files_of(index);
    if (!last_of_frame) request(file_of(run_.frames[index], subframe + 1));
    else if (index + 1 < run_.frames.size() && !is_missing(index + 1)) {
        const std::vector<int> next = files_of(index + 1);
        request(next.front());
        wanted.insert(wanted.end(), next.begin(), next.end());
    }
    const CapturePointer current = holds ? held(index) : get(file);
    std::erase_if(reads_, [&](const auto& read) {
        return std::find(wanted.begin(), wanted.end(), read.first) == wanted.end() ||
               (subframes_ > 1 && read.first <= file && read.first >= file_of(run_.frames[index], 0));
    });
    if (!holds && last_of_frame) last_ = current;
    return current;
}

FrameLoader::CapturePointer FrameLoader::neighbour(std::size_t index, int offset) {
    const int frame = run_.frames[index];
    return has_neighbour(frame, offset) ? get(file_of(frame + offset, subframes_ / 2)) : nullptr;
}

}  // namespace aftershade
