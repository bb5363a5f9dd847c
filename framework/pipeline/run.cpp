#include "framework/pipeline/run.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <memory>
#include <tuple>
#include <utility>

#include "framework/capture/capture_window.h"
#include "framework/image/window.h"
#include "framework/pipeline/frame_loader.h"
#include "framework/pipeline/output.h"

namespace aftershade {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

void add_times(std::vector<PassStatistics>& passes, const std::vector<graph::PassTime>& times) {
    for (const graph::PassTime& time : times) {
        auto found =
            std::find_if(passes.begin(), passes.end(), [&](const auto& p) { return p.pass == time.pass; });
        if (found == passes.end())
            found = passes.insert(passes.end(), {time.pass, 0, time.milliseconds, 0, 0});
        found->total_ms += time.milliseconds;
        found->min_ms = std::min(found->min_ms, time.milliseconds);
        found->max_ms = std::max(found->max_ms, time.milliseconds);
        ++found->frames;
    }
}

using Written = std::vector<std::filesystem::path>;

/// Waits for the files of the frame before, if there is one, and tells of them.
void finish_write(std::future<Written>& pending, RunReport& report, const RunObserver& observer) {
    if (!pending.valid()) return;
    const auto start = Clock::now();
    const Written written = pending.get();
    report.write_ms += milliseconds_since(start);
    ++report.frames_done;
    if (observer.file_written)
        for (const auto& path : written) observer.file_written(path);
}

std::vector<std::string> roles_to_read(const Pipeline& pipeline, const OutputOptions& outputs) {
    std::vector<std::string> roles = pipeline.capture_roles();
    for (const std::string& role : outputs.roles)
        if (std::find(roles.begin(), roles.end(), role) == roles.end()) roles.push_back(role);
    return roles;
}

}  // namespace

ExitCode RunReport::exit_code() const {
    if (interrupted) return ExitCode::interrupted;
    const bool any = frames_done + frames_unwritten > 0;
    if (!any) return ExitCode::capture;
    return failures.empty() ? ExitCode::done : ExitCode::partial;
}

namespace {

/// One frame from its first sub-frame to its results.
class FrameRun {
public:
    FrameRun(PipelineRenderer& renderer, FrameLoader& loader, const Sequence& sequence, const RunOptions& run)
        : renderer_(renderer), loader_(loader), sequence_(sequence), run_(run) {}

    struct Rendered {
        std::shared_ptr<const Capture> capture;
        std::shared_ptr<const FrameResult> result;
    };

    /// Reading's faults come as Error(ExitCode::capture).
    Rendered render(std::size_t index, const std::vector<std::string>& roles, RunReport& report,
                    const RunObserver& observer) {
        FrameInputs inputs;
        inputs.subframe_count = loader_.subframe_count();
        inputs.scale = 1.0 / run_.scale_divisor;
        inputs.fps = sequence_.fps;
        inputs.begins_shot = loader_.begins_shot(index);
        const auto previous = timed_read(report, [&] { return loader_.neighbour(index, -1); });
        const auto next = timed_read(report, [&] { return loader_.neighbour(index, 1); });
        inputs.previous = previous.get();
        inputs.next = next.get();
        std::shared_ptr<const Capture> current, centre;
        FrameResult result;
        std::vector<graph::PassTime> times;
        std::string history_reset;
        std::vector<std::string> messages;
        for (int subframe = 0; subframe < inputs.subframe_count; ++subframe) {
            current = timed_read(report, [&] { return loader_.take(index, subframe); });
            if (subframe == inputs.subframe_count / 2) centre = current;
            if (subframe == 0 && observer.frame_started) observer.frame_started(*current);
            inputs.capture = current.get();
            inputs.centre = centre.get();
            inputs.subframe = subframe;
            result = renderer_.render(inputs, roles, true);
            times.insert(times.end(), result.times.begin(), result.times.end());
            if (subframe == 0) history_reset = result.history_reset;
            messages.insert(messages.end(), result.messages.begin(), result.messages.end());
        }
        result.times = std::move(times);
        result.messages = std::move(messages);
        result.history_reset = std::move(history_reset);
        return finished(std::move(centre), std::move(result));
    }

private:
    template <typename Read>
    static std::shared_ptr<const Capture> timed_read(RunReport& report, const Read& read) {
        const auto start = Clock::now();
        auto capture = read();
        report.read_ms += milliseconds_since(start);
        return capture;
    }

    /// The frame without the margin of its region.
    Rendered finished(std::shared_ptr<const Capture> capture, FrameResult result) const {
        if (run_.region) {
            auto part = std::make_shared<Capture>(*capture);
            const Window& display = capture->header.display_window;
            const Window& r = *run_.region;
            const Window full{display.min_x + r.min_x, display.min_y + r.min_y, display.min_x + r.max_x,
                              display.min_y + r.max_y};
            const Window region = scaled_window(full, display, run_.scale_divisor);
            crop_capture(*part, region);
            for (auto* images : {&result.images, &result.taps})
                for (auto& [name, image] : *images)
                    if (image.width() == capture->header.data_window.width() &&
                        image.height() == capture->header.data_window.height())
                        image = place_in_window(std::move(image), capture->header.data_window,
                                                part->header.data_window, 0);
            result.region = region;
            capture = std::move(part);
        }
        return {std::move(capture), std::make_shared<const FrameResult>(std::move(result))};
    }

    PipelineRenderer& renderer_;
    FrameLoader& loader_;
    const Sequence& sequence_;
    const RunOptions& run_;
};

/// Whether the frame is left out, after it was told of.
bool skips(const FrameLoader& loader, const RunOptions& run, std::size_t index, const RunObserver& observer) {
    if (run.missing == MissingFrame::error || !loader.is_missing(index)) return false;
    const bool skip = run.missing == MissingFrame::skip;
    if ((skip || loader.can_hold()) && observer.frame_missing)
        observer.frame_missing(run.frames[index], skip ? "skipped" : "held");
    return skip;
}

void tell(const CaptureHeader& header, const FrameResult& result, bool is_first, const RunOptions& run,
          const RunObserver& observer) {
    if (run.audit && observer.frame_audited) observer.frame_audited(header, result.audit);
    for (const std::string& line : result.messages)
        if (observer.native_message) observer.native_message(header.frame, line);
    if (!is_first && !result.history_reset.empty() && observer.history_reset)
        observer.history_reset(header.frame, result.history_reset);
}

std::future<Written> write_later(const RunSetup& setup, const FrameRun::Rendered& frame, int number,
                                 Clock::time_point start) {
    OutputOptions outputs = setup.outputs;
    if (setup.hooks.fingerprint) outputs.fingerprint = setup.hooks.fingerprint(number);
    return std::async(std::launch::async, [frame, number, start, outputs = std::move(outputs), &setup] {
        Written written = write_outputs(outputs, *frame.result, *frame.capture, setup.reader);
        if (setup.hooks.frame_written)
            setup.hooks.frame_written(number, written, milliseconds_since(start) / 1000);
        return written;
    });
}

}  // namespace

RunReport run_frames(const RunSetup& setup, const RunObserver& observer, const std::atomic<bool>& stop) {
    RunReport report;
    const auto start = Clock::now();
    const auto& [context, pipeline, sequence, reader, run, outputs, data_folder, hooks] = setup;
    const std::vector<std::string> result_roles = wanted_roles(outputs);
    PipelineRenderer renderer(context, pipeline, data_folder, run.natives);
    renderer.set_audit(run.audit);
    renderer.set_telemetry(run.telemetry);
    if (!run.history_in.empty()) renderer.load_history(run.history_in);
    FrameLoader loader(sequence, reader, pipeline, run, roles_to_read(pipeline, outputs));
    FrameRun frame_run(renderer, loader, sequence, run);
    std::future<Written> pending_write;
    bool any_rendered = false;
    const bool is_native = pipeline.has_native();
    for (std::size_t i = 0; i < run.frames.size(); ++i) {
        report.interrupted = stop;
        if (report.interrupted) break;
        if (skips(loader, run, i, observer)) {
            ++report.frames_skipped;
            continue;
        }
        // A plug-in may end this process: what is done must be on disk before its code runs.
        if (is_native) finish_write(pending_write, report, observer);
        FrameRun::Rendered frame;
        const auto frame_start = Clock::now();
        const int number = run.frames[i];
        if (hooks.before_frame) hooks.before_frame(number, renderer);
        try {
            frame = frame_run.render(i, result_roles, report, observer);
        } catch (const Error& error) {
            if (error.exit_code() != ExitCode::capture) throw;
            report.failures.emplace_back(error.what());
            if (observer.frame_failed) observer.frame_failed(error.what());
            if (hooks.frame_failed) hooks.frame_failed(number, renderer);
            continue;
        }
        tell(frame.capture->header, *frame.result, !any_rendered, run, observer);
        any_rendered = true;
        add_times(report.passes, frame.result->times);
        if (frame.result->telemetry) report.telemetry.push_back(*frame.result->telemetry);
        finish_write(pending_write, report, observer);
        if (hooks.is_written && !hooks.is_written(number)) ++report.frames_unwritten;
        else pending_write = write_later(setup, frame, number, frame_start);
        if (hooks.after_frame) hooks.after_frame(number, renderer);
    }
    finish_write(pending_write, report, observer);
    if (!run.history_out.empty() && any_rendered)
        renderer.save_history(run.history_out, hooks.last_fingerprint ? hooks.last_fingerprint() : "");
    report.graph_dot = renderer.graph_dot();
    std::tie(report.bytes, report.bytes_unaliased) = renderer.graph_bytes();
    report.wall_ms = milliseconds_since(start);
    return report;
}

}  // namespace aftershade
