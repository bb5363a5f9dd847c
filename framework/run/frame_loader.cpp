#include "framework/run/frame_loader.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

#include "framework/base/error.h"
#include "framework/base/memory_limit.h"
#include "framework/capture/capture_window.h"
#include "framework/file/exr_file.h"
#include "framework/image/role.h"
#include "framework/look/pixel_shape.h"
#include "framework/run/nan_policy.h"

namespace aftershade {

namespace {

void add_missing(std::vector<RoleId>& list, const std::vector<RoleId>& items) {
    for (const RoleId& item : items)
        if (std::find(list.begin(), list.end(), item) == list.end()) list.push_back(item);
}

/// The region at full scale in the coordinates of the windows.
Window region_of(const RunOptions& run, const Window& display, int margin = 0) {
    return {display.min_x + run.region->min_x - margin, display.min_y + run.region->min_y - margin,
            display.min_x + run.region->max_x + margin, display.min_y + run.region->max_y + margin};
}

/// With what is rendered around it.
Window region_with_margin(const RunOptions& run, const std::optional<RegionNeeds>& needs,
                          const CaptureHeader& header) {
    const Window& display = header.display_window;
    if (run.region_margin_px) return region_of(run, display, *run.region_margin_px);
    const Window region = region_of(run, display), common = intersection(region, header.data_window);
    // Without a pixel to write, it is left to crop_capture() to say so.
    if (common.width() < 1 || common.height() < 1) return region;
    if (!needs) return header.data_window;
    const int divisor = run.scale_divisor;
    const Window part = window_with_needs(scaled_window(region, display, divisor), *needs,
                                          scaled_window(header.data_window, display, divisor));
    return {display.min_x + (part.min_x - display.min_x) * divisor,
            display.min_y + (part.min_y - display.min_y) * divisor,
            display.min_x + (part.max_x + 1 - display.min_x) * divisor - 1,
            display.min_y + (part.max_y + 1 - display.min_y) * divisor - 1};
}

std::uint64_t bytes_of(const Capture& capture) {
    std::uint64_t bytes = 0;
    for (const auto& [role, image] : capture.images)
        bytes +=
            std::uint64_t(image.width()) * std::uint64_t(image.height()) * image.channels() * sizeof(float);
    return bytes;
}

/// A file has parts for about four cores at once; results to be written take about as much as captures.
int frames_ahead_of(const RunOptions& run, const Capture& capture) {
    if (run.frames_ahead > 0) return run.frames_ahead;
    constexpr int kCoresOfAFrame = 4, kMost = 8, kPartOfMemory = 8;
    const std::uint64_t room = address_space_left().value_or(machine_memory_bytes()) / kPartOfMemory;
    const auto fit = std::uint64_t(exr_threads() / kCoresOfAFrame);
    return int(std::clamp<std::uint64_t>(std::min(fit, room / std::max<std::uint64_t>(1, bytes_of(capture))),
                                         1, kMost));
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
                         const RunOptions& run, std::vector<RoleId> roles)
    : sequence_(sequence),
      reader_(reader),
      pipeline_(pipeline),
      run_(run),
      files_(sequence, reader, pipeline),
      roles_(std::move(roles)),
      region_needs_(run.region ? needs_of_region(pipeline, 1.0 / run.scale_divisor) : std::nullopt),
      objects_(pipeline) {
    for (const int offset : pipeline.neighbour_offsets())
        add_missing(roles_, pipeline.neighbour_roles(offset));
    if (!run.frames.empty() && !is_missing(0))
        for (const int file : files_.numbers(run.frames[0])) request(file);
}

FrameLoader::~FrameLoader() {
    for (const auto& [file, read] : reads_) read.wait();
}

bool FrameLoader::is_missing(std::size_t index) const {
    return files_.is_missing(run_.frames[index]);
}

bool FrameLoader::begins_shot(std::size_t index) const {
    return files_.begins_shot(run_.frames[index]);
}

Capture FrameLoader::read(int file) const {
    const BusyTime busy(busy_ms_);
    const TraceScope traced(run_.trace, "decode", "file " + std::to_string(file));
    Capture capture;
    try {
        capture = reader_.read(file, roles_);
    } catch (const UnknownObject& error) {
        throw objects_.placed(error);
    }
    require_capture_roles(pipeline_, capture.header, &reader_);
    objects_.look_at(capture);
    {
        const TraceScope scan(run_.trace, "scan", "file " + std::to_string(file));
        apply_nan_policy(run_.on_nan, capture);  // before scaling, which spreads NaN
    }
    place(capture, file);
    return capture;
}

void FrameLoader::place(Capture& capture, int file) const {
    if (run_.region) {
        const PixelStretch stretch = SquareSteps(pipeline_, capture.header.pixel_aspect).stretch();
        const auto needs = region_needs_ ? in_stored_pixels(*region_needs_, stretch) : std::nullopt;
        std::string fault = region_fault(capture.header, region_of(run_, capture.header.display_window));
        crop_capture(capture, region_with_margin(run_, needs, capture.header));
        if (!fault.empty()) capture.header.warnings.push_back(std::move(fault));
    }
    scale_capture(capture, run_.scale_divisor);
    const int subframe = (file % sequence_.subframes + sequence_.subframes) % sequence_.subframes;
    capture.header.frame = (file - subframe) / sequence_.subframes;
}

std::optional<Capture> FrameLoader::outline(std::size_t index) const {
    if (is_missing(index) || subframe_count() > 1 || !pipeline_.neighbour_offsets().empty())
        return std::nullopt;
    Capture capture;
    try {
        const int file = files_.number(run_.frames[index], 0);
        capture.header = reader_.read_header(file);
        place(capture, file);
    } catch (const Error&) {
        return std::nullopt;  // take() says why
    }
    const auto& there = capture.header.roles;
    for (const RoleId& role : roles_)
        if (role.is_coverage() || std::ranges::find(there, role) != there.end()) capture.images[role];
    return capture;
}

bool FrameLoader::is_read(std::size_t index) const {
    if (is_missing(index)) return false;
    const int frame = run_.frames[index];
    std::vector<int> files{files_.number(frame, 0)};
    for (const int offset : pipeline_.neighbour_offsets())
        if (files_.has_neighbour(frame, offset)) files.push_back(files_.neighbour_number(frame, offset));
    return std::ranges::all_of(files, [&](int file) {
        const auto read = reads_.find(file);
        return read != reads_.end() &&
               read->second.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
}

void FrameLoader::request(int file) {
    if (reads_.contains(file)) return;
    reads_[file] = std::async(std::launch::async, [this, file]() -> CapturePointer {
                       return std::make_shared<Capture>(read(file));
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
    const int frame = run_.frames[index];
    const int file = files_.number(frame, subframe);
    const bool holds = is_missing(index) && run_.missing == MissingFrame::hold && last_;
    const bool last_of_frame = subframe + 1 == subframe_count();
    if (!holds) {
        request(file);
        reads_.at(file).wait();
    }
    // What comes next is read while this one is worked on; what no longer matters is let go.
    std::vector<int> wanted = files_.numbers(frame);
    if (!last_of_frame) request(files_.number(frame, subframe + 1));
    else request_next(index, wanted);
    const CapturePointer current = holds ? held(index) : get(file);
    std::erase_if(reads_, [&](const auto& read) {
        return std::find(wanted.begin(), wanted.end(), read.first) == wanted.end() ||
               (subframe_count() > 1 && read.first <= file && read.first >= files_.number(frame, 0));
    });
    if (!holds && last_of_frame) last_ = current;
    frames_ahead_ = frames_ahead_of(run_, *current);
    return current;
}

/// Of frames behind the next one that lie in many files, the first alone is read ahead.
void FrameLoader::request_next(std::size_t index, std::vector<int>& wanted) {
    const std::size_t end = std::min(run_.frames.size(), index + 1 + std::size_t(frames_ahead_));
    for (std::size_t next = index + 1; next < end; ++next) {
        if (is_missing(next)) continue;
        const std::vector<int> files = files_.numbers(run_.frames[next]);
        request(files.front());
        wanted.insert(wanted.end(), files.begin(), files.end());
    }
}

FrameLoader::Neighbours FrameLoader::neighbours(std::size_t index) {
    const int frame = run_.frames[index];
    Neighbours neighbours;
    for (const int offset : pipeline_.neighbour_offsets())
        if (files_.has_neighbour(frame, offset))
            neighbours[offset] = get(files_.neighbour_number(frame, offset));
    return neighbours;
}

}  // namespace aftershade
