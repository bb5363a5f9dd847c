#include "framework/pipeline/run.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <exception>
#include <future>
#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include "framework/capture/capture_window.h"
#include "framework/core/memory_limit.h"
#include "framework/image/window.h"
#include "framework/pipeline/frame_loader.h"
#include "framework/pipeline/nan_policy.h"
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

void note_non_finite(int frame, RunReport& report) {
    if (report.frames_non_finite.empty() || report.frames_non_finite.back() != frame)
        report.frames_non_finite.push_back(frame);
}

/// Reports how each frame ends, with the time since the one before.
class Outcomes {
public:
    Outcomes(RunReport& report, const RunObserver& observer) : report_(report), observer_(observer) {}

    void failed(int frame, const Error& error) {
        report_.failures.push_back({frame, error.what(), error.exit_code()});
        if (observer_.frame_failed) observer_.frame_failed(error.what());
        finished(frame, FrameOutcome::Kind::failed, error.what());
    }
    void skipped(int frame) {
        ++report_.frames_skipped;
        finished(frame, FrameOutcome::Kind::skipped);
    }
    void done(int frame, const std::vector<std::filesystem::path>& files) {
        ++report_.frames_done;
        if (observer_.file_written)
            for (const auto& path : files) observer_.file_written(path);
        finished(frame, FrameOutcome::Kind::done);
    }

private:
    void finished(int frame, FrameOutcome::Kind kind, const std::string& message = "") {
        const double seconds = milliseconds_since(last_) / 1000;
        last_ = Clock::now();
        if (observer_.frame_finished) observer_.frame_finished({frame, kind, message, seconds});
    }

    RunReport& report_;
    const RunObserver& observer_;
    Clock::time_point last_ = Clock::now();
};

struct Written {
    std::vector<std::filesystem::path> paths;
    double milliseconds = 0;
};

Written write_frame(const RunSetup& setup, const FrameResult& result, const Capture& capture) {
    const auto start = Clock::now();
    const TraceScope traced(setup.options.trace, "encode", "frame " + std::to_string(capture.header.frame));
    Written written;
    written.paths = write_outputs(setup.outputs, result, capture, setup.reader);
    written.milliseconds = milliseconds_since(start);
    return written;
}

/// The files of one frame, written while the next one is rendered.
struct PendingWrite {
    int frame = 0;
    std::future<Written> files{};
};

/// Waits for the files of the frame before, if there is one, and reports them.
void finish_write(PendingWrite& pending, RunReport& report, Outcomes& outcomes) {
    if (!pending.files.valid()) return;
    const auto start = Clock::now();
    const Written written = pending.files.get();
    report.write_ms += milliseconds_since(start);
    report.encode_ms += written.milliseconds;
    outcomes.done(pending.frame, written.paths);
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
    if (failures.empty()) return frames_done > 0 ? ExitCode::done : ExitCode::capture;
    return frames_done > 0 ? ExitCode::partial : failures.front().code;
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
        std::vector<NonFiniteOutput> non_finite;
    };

    /// Reading's faults come as Error(ExitCode::capture), and so do pixels that NanPolicy::fail refuses.
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
            meet_non_finite(*current, report, observer);
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

    /// Before the effects see it, and before any history does.
    void meet_non_finite(const Capture& capture, RunReport& report, const RunObserver& observer) const {
        if (capture.non_finite.empty()) return;
        note_non_finite(capture.header.frame, report);
        const auto sentences = describe_non_finite(run_.on_nan, capture);
        if (run_.on_nan == NanPolicy::fail) throw Error(ExitCode::capture, sentences.front());
        if (observer.non_finite) std::ranges::for_each(sentences, observer.non_finite);
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
        auto outputs = apply_nan_policy(run_.on_nan, result);
        return {std::move(capture), std::make_shared<const FrameResult>(std::move(result)),
                std::move(outputs)};
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

/// A frame with its passes. These have lengths alone; they ended when the frame did, one after the other.
void trace_frame(Trace& trace, int frame, Clock::time_point begin,
                 const std::vector<graph::PassTime>& times) {
    const Clock::time_point end = Clock::now();
    trace.add("frames", "frame " + std::to_string(frame), begin, end);
    Clock::time_point at = end;
    for (auto pass = times.rbegin(); pass != times.rend(); ++pass) {
        const std::chrono::duration<double, std::milli> length(pass->milliseconds);
        const Clock::time_point start = at - std::chrono::duration_cast<Clock::duration>(length);
        trace.add("passes", pass->pass, start, at);
        at = start;
    }
}

/// Reports outputs that are not finite. Whether the frame may be written.
bool accept_outputs(const FrameRun::Rendered& frame, NanPolicy policy, RunReport& report,
                    const RunObserver& observer, Outcomes& outcomes) {
    if (frame.non_finite.empty()) return true;
    const Capture& capture = *frame.capture;
    note_non_finite(capture.header.frame, report);
    const auto sentences = describe_non_finite(policy, frame.non_finite, capture);
    if (policy == NanPolicy::fail) {
        outcomes.failed(capture.header.frame, Error(ExitCode::effect, sentences.front()));
        return false;
    }
    if (observer.non_finite) std::ranges::for_each(sentences, observer.non_finite);
    return true;
}

}  // namespace

namespace {

RunReport render_frames(const RunSetup& setup, PipelineRenderer& renderer, const RunObserver& observer,
                        const std::atomic<bool>& stop) {
    RunReport report;
    const auto start = Clock::now();
    const auto& [context, pipeline, sequence, reader, run, outputs, data_folder] = setup;
    const std::vector<std::string> result_roles = wanted_roles(outputs);
    renderer.set_audit(run.audit);
    renderer.set_telemetry(run.telemetry);
    if (!run.history_in.empty()) renderer.load_history(run.history_in);
    FrameLoader loader(sequence, reader, pipeline, run, roles_to_read(pipeline, outputs));
    FrameRun frame_run(renderer, loader, sequence, run);
    Outcomes outcomes(report, observer);
    PendingWrite pending_write;
    bool any_rendered = false;
    const bool is_native = pipeline.has_native();
    for (std::size_t i = 0; i < run.frames.size(); ++i) {
        report.interrupted = stop;
        if (report.interrupted) {
            report.frames_left.assign(run.frames.begin() + std::ptrdiff_t(i), run.frames.end());
            break;
        }
        const bool warms_up = i < std::size_t(run.warmup_frames);
        if (skips(loader, run, i, observer)) {
            if (!warms_up) outcomes.skipped(run.frames[i]);
            continue;
        }
        // A plug-in may end this process: what is done must be on disk before its code runs.
        if (is_native) finish_write(pending_write, report, outcomes);
        FrameRun::Rendered frame;
        const auto begin = Clock::now();
        try {
            frame = frame_run.render(i, result_roles, report, observer);
        } catch (const Error& error) {
            if (error.exit_code() != ExitCode::capture) throw;
            finish_write(pending_write, report, outcomes);
            if (!warms_up) outcomes.failed(run.frames[i], error);
            else if (observer.frame_failed) observer.frame_failed(error.what());
            continue;
        }
        if (run.trace) trace_frame(*run.trace, frame.capture->header.frame, begin, frame.result->times);
        tell(frame.capture->header, *frame.result, !any_rendered, run, observer);
        any_rendered = true;
        if (!frame.result->history_reset.empty()) report.history_begin = frame.capture->header.frame;
        if (warms_up) continue;
        add_times(report.passes, frame.result->times);
        if (frame.result->telemetry) report.telemetry.push_back(*frame.result->telemetry);
        finish_write(pending_write, report, outcomes);
        if (!accept_outputs(frame, run.on_nan, report, observer, outcomes)) continue;
        pending_write = {run.frames[i], std::async(std::launch::async, [frame, &setup] {
                             return write_frame(setup, *frame.result, *frame.capture);
                         })};
    }
    finish_write(pending_write, report, outcomes);
    report.history_saved = !run.history_out.empty() && any_rendered;
    if (report.history_saved) renderer.save_history(run.history_out);
    report.decode_ms = loader.busy_ms();
    report.graph_dot = renderer.graph_dot();
    std::tie(report.bytes, report.bytes_unaliased) = renderer.graph_bytes();
    report.wall_ms = milliseconds_since(start);
    return report;
}

}  // namespace

RunReport run_frames(const RunSetup& setup, const RunObserver& observer, const std::atomic<bool>& stop) {
    PipelineRenderer renderer(setup.context, setup.pipeline, setup.data_folder, setup.options.natives);
    try {
        return render_frames(setup, renderer, observer, stop);
    } catch (const std::exception& error) {
        if (is_out_of_memory(error)) setup.context.abandon();  // before the renderer goes
        throw;
    }
}

}  // namespace aftershade
