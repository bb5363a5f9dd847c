#include "framework/run/frame_run.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/capture/capture_window.h"
#include "framework/image/window.h"
#include "framework/render/trace.h"

namespace aftershade {

namespace {

using Clock = std::chrono::steady_clock;

template <typename Read>
auto timed_read(RunReport& report, const Read& read) {
    const auto start = Clock::now();
    auto captures = read();
    report.read_ms += std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    return captures;
}

void add_new(std::vector<std::string>& list, const std::vector<std::string>& items) {
    for (const std::string& item : items)
        if (std::ranges::find(list, item) == list.end()) list.push_back(item);
}

}  // namespace

Window written_window(const Window& display, const RunOptions& run) {
    Window full = display;
    if (run.region)
        full = {display.min_x + run.region->min_x, display.min_y + run.region->min_y,
                display.min_x + run.region->max_x, display.min_y + run.region->max_y};
    return scaled_window(full, display, run.scale_divisor);
}

void note_non_finite(int frame, RunReport& report) {
    // A frame's files are reported after the next frame's capture.
    std::vector<int>& frames = report.frames_non_finite;
    if (std::ranges::find(frames, frame) == frames.end()) frames.push_back(frame);
}

FrameSetting FrameRun::setting_of(std::size_t index) const {
    FrameSetting setting;
    setting.begins_shot = loader_.begins_shot(index);
    setting.subframe_count = loader_.subframe_count();
    setting.scale = 1.0 / run_.scale_divisor;
    setting.fps = sequence_.fps;
    return setting;
}

void FrameRun::build_ahead(std::size_t index, const std::vector<std::string>& roles) {
    if (!renderer_.can_build_ahead()) return;
    if (const std::optional<Capture> outline = loader_.outline(index))
        renderer_.build_ahead(setting_of(index).inputs(*outline, 0, &*outline), roles);
}

FrameRun::Begun FrameRun::begin(std::size_t index, const std::vector<std::string>& roles, RunReport& report,
                                const RunObserver& observer) {
    FrameSetting setting = setting_of(index);
    setting.neighbours = timed_read(report, [&] { return loader_.neighbours(index); });
    std::vector<std::string> said, differences;
    const auto take = [&](int subframe) {
        auto capture = timed_read(report, [&] { return loader_.take(index, subframe); });
        if (subframe == 0 && observer.frame_started) observer.frame_started(*capture);
        meet_non_finite(*capture, report, observer);
        const CaptureHeader& header = capture->header;
        std::vector<std::string> news = header.differences;
        // The warnings of the first sub-frame are printed when the frame starts.
        for (const std::string& warning : header.warnings)
            if (subframe > 0 && std::ranges::find(said, warning) == said.end()) news.push_back(warning);
        for (const std::string& text : news) add_new(differences, {header.path.string() + ": " + text});
        add_new(said, header.warnings);
        add_new(said, header.differences);
        return capture;
    };
    Begun begun;
    begun.frame = begin_frame(renderer_, setting, take, roles);
    begun.message = joined(said, "; ", "; ");
    begun.differences = std::move(differences);
    return begun;
}

FrameRun::Rendered FrameRun::finish(Begun begun) const {
    DrawnFrame drawn = finish_frame(std::move(begun.frame));
    Rendered rendered = finished(std::move(drawn.centre), std::move(drawn.result));
    rendered.message = std::move(begun.message);
    rendered.differences = std::move(begun.differences);
    return rendered;
}

/// Before the effects see it, and before any history does.
void FrameRun::meet_non_finite(const Capture& capture, RunReport& report, const RunObserver& observer) const {
    if (capture.non_finite.empty()) return;
    note_non_finite(capture.header.frame, report);
    const auto sentences = describe_non_finite(run_.on_nan, capture);
    if (run_.on_nan == NanPolicy::fail) throw Error(ErrorKind::capture, sentences.front());
    if (observer.non_finite) std::ranges::for_each(sentences, observer.non_finite);
}

/// The frame without the margin of its region.
FrameRun::Rendered FrameRun::finished(std::shared_ptr<const Capture> capture, FrameResult result) const {
    if (run_.region) {
        auto part = std::make_shared<Capture>(*capture);
        const Window region = written_window(capture->header.display_window, run_);
        crop_capture(*part, region);
        for (auto* images : {&result.images, &result.taps})
            for (auto& [name, image] : *images)
                if (image.width() == capture->header.data_window.width() &&
                    image.height() == capture->header.data_window.height())
                    image = place_in_window(std::move(image), capture->header.data_window,
                                            part->header.data_window, 0);
        result.region = intersection(region, whole_picture(capture->header));
        capture = std::move(part);
    }
    const TraceScope scan(run_.trace, "scan", "frame " + std::to_string(capture->header.frame));
    auto outputs = apply_nan_policy(run_.on_nan, result);
    return {std::move(capture),
            std::make_shared<const FrameResult>(std::move(result)),
            std::move(outputs),
            {},
            {}};
}

}  // namespace aftershade
