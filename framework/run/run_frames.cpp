#include "framework/run/run_frames.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "framework/base/memory_limit.h"
#include "framework/base/text.h"
#include "framework/gpu/timer.h"
#include "framework/run/frame_loader.h"
#include "framework/run/frame_run.h"
#include "framework/run/nan_policy.h"
#include "framework/run/output.h"

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

/// Reports how each frame ends, with the time since the one before.
class Outcomes {
public:
    Outcomes(RunReport& report, const RunObserver& observer) : report_(report), observer_(observer) {}

    void failed(int frame, const Error& error) {
        report_.failures.push_back({frame, error.what(), error.kind()});
        if (observer_.frame_failed) observer_.frame_failed(error.what());
        finished(frame, FrameOutcome::Kind::failed, error.what());
    }
    void skipped(int frame) {
        ++report_.frames_skipped;
        finished(frame, FrameOutcome::Kind::skipped);
    }
    void done(int frame, const std::vector<std::filesystem::path>& files, const std::string& message) {
        ++report_.frames_done;
        if (observer_.file_written)
            for (const auto& path : files) observer_.file_written(path);
        finished(frame, FrameOutcome::Kind::done, message);
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
    WrittenFiles files;
    double milliseconds = 0;
};

Written write_frame(const RunSetup& setup, const OutputOptions& outputs, const FrameResult& result,
                    const Capture& capture) {
    const auto start = Clock::now();
    const TraceScope traced(setup.options.trace, "encode", "frame " + std::to_string(capture.header.frame));
    Written written;
    written.files = write_outputs(outputs, result, capture, setup.reader);
    written.milliseconds = milliseconds_since(start);
    return written;
}

/// The files of one frame, written while others are rendered.
struct PendingWrite {
    int frame = 0;
    std::shared_future<Written> files{};
    std::string message{};  ///< for reports
};

std::vector<RoleId> roles_to_read(const Pipeline& pipeline, const OutputOptions& outputs) {
    std::vector<RoleId> roles = pipeline.capture_roles();
    for (const std::string& role : outputs.roles)
        if (std::find(roles.begin(), roles.end(), role) == roles.end()) roles.emplace_back(role);
    return roles;
}

/// Whether the frame is left out; it is reported first.
bool skips(const FrameLoader& loader, const RunOptions& run, std::size_t index, const RunObserver& observer) {
    if (run.missing == MissingFrame::error || !loader.is_missing(index)) return false;
    const bool skip = run.missing == MissingFrame::skip;
    if ((skip || loader.can_hold()) && observer.frame_missing)
        observer.frame_missing(run.frames[index], skip ? "skipped" : "held");
    return skip;
}

void report_result(const CaptureHeader& header, const FrameResult& result, bool is_first,
                   const RunOptions& run, const RunObserver& observer) {
    if (run.drawing.audits && observer.frame_audited) observer.frame_audited(header, result.audit);
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
        outcomes.failed(capture.header.frame, Error(ErrorKind::effect, sentences.front()));
        return false;
    }
    if (observer.non_finite) std::ranges::for_each(sentences, observer.non_finite);
    return true;
}

/// The frames of a run, one after the other.
class FrameLoop {
public:
    /// `end_gl` ends the renderer, and the context if nobody needs it any longer.
    FrameLoop(const RunSetup& setup, const gpu::Context& context, PipelineRenderer& renderer,
              FrameLoader& loader, const RunObserver& observer, std::function<void()> end_gl)
        : setup_(setup),
          renderer_(renderer),
          observer_(observer),
          loader_(loader),
          frame_run_(renderer, loader_, setup.sequence, setup.options),
          outcomes_(report_, observer),
          end_gl_(std::move(end_gl)),
          context_(context),
          // A frame that is refused is reported before the next one is looked at.
          overlaps_(context.info().maps_transfers && setup.options.on_nan != NanPolicy::fail) {
        report_.gl = context.info();
        report_.clock = gpu::Timer::clock_name(context);
    }

    RunReport run(const std::atomic<bool>& stop) {
        const auto start = Clock::now();
        const RunOptions& run = setup_.options;
        // A mended pixel is the mean of floats around it.
        if (run.on_nan != NanPolicy::mend) renderer_.read_as_halfs(roles_written_as_halfs(setup_.outputs));
        if (!run.frames.empty()) frame_run_.build_ahead(0, wanted());
        try {
            frames(stop);
        } catch (const Error& error) {
            // It is not that of the frame before, whose passes were issued.
            if (error.kind() != ErrorKind::memory) end_frame();
            throw;
        }
        end_frame();
        report_.graph_dot = renderer_.graph_dot();
        report_.draws = renderer_.draws();
        std::tie(report_.bytes, report_.bytes_unaliased) = renderer_.graph_bytes();
        report_.transfers = context_.transfer_use();
        // One of fewer frames would pass for that of the run.
        report_.history_saved = !run.history_out.empty() && any_rendered_ && !report_.interrupted;
        // Frees memory while the last files are packed; a history is saved once they are there.
        if (!report_.history_saved) end_gl_();
        finish_writes();
        if (report_.history_saved)
            renderer_.save_history(run.history_out,
                                   setup_.hooks.last_fingerprint ? setup_.hooks.last_fingerprint() : "");
        report_.objects_unmatched = loader_.objects().unmatched();
        std::ranges::sort(report_.frames_non_finite);
        report_.decode_ms = loader_.busy_ms();
        report_.wall_ms = milliseconds_since(start);
        return std::move(report_);
    }

private:
    struct OpenFrame {
        FrameRun::Begun begun;
        std::size_t index = 0;
        int number = 0;
        Clock::time_point begin;
    };

    std::vector<std::string> wanted() const {
        return wanted_roles(setup_.outputs, setup_.pipeline.writes_role(kDisplayRole));
    }
    bool warms_up(std::size_t index) const { return index < std::size_t(setup_.options.warmup_frames); }

    void frames(const std::atomic<bool>& stop) {
        const RunOptions& run = setup_.options;
        for (std::size_t i = 0; i < run.frames.size(); ++i) {
            report_.interrupted = stop;
            if (report_.interrupted || (run.stop_on_error && !report_.failures.empty())) break;
            frame(i);
        }
    }

    void frame(std::size_t index) {
        const int number = setup_.options.frames[index];
        // There is time for the frame before.
        if (!loader_.is_read(index)) end_frame();
        if (skips(loader_, setup_.options, index, observer_)) {
            if (!warms_up(index)) outcomes_.skipped(number);
            return;
        }
        const auto begin = Clock::now();
        const RunHooks& hooks = setup_.hooks;
        if (hooks.before_frame) hooks.before_frame(number, renderer_);
        std::optional<OpenFrame> frame;
        try {
            frame = OpenFrame{frame_run_.begin(index, wanted(), report_, observer_), index, number, begin};
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::memory) {
                end_frame();
                finish_writes();
            }
            if (error.kind() != ErrorKind::capture) throw;
            if (!warms_up(index)) outcomes_.failed(number, error);
            else if (observer_.frame_failed) observer_.frame_failed(error.what());
            if (hooks.frame_failed) hooks.frame_failed(number, renderer_);
            return;
        }
        end_frame();
        open_ = std::move(frame);
        if (!overlaps_) end_frame();
        if (hooks.after_frame) hooks.after_frame(number, renderer_);
    }

    /// Collects what the frame that was begun last has made, and reports and writes it.
    void end_frame() {
        if (!open_) return;
        OpenFrame open = std::move(*open_);
        open_.reset();
        FrameRun::Rendered frame;
        try {
            frame = frame_run_.finish(std::move(open.begun));
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::memory) finish_writes();
            throw;
        }
        report_frame(frame, open.begin);
        finish_writes(most_writes() - 1);
        const RunHooks& hooks = setup_.hooks;
        if (warms_up(open.index) || (hooks.is_written && !hooks.is_written(open.number)))
            report_.frames_unwritten += warms_up(open.index) ? 0 : 1;
        else if (accept_outputs(frame, setup_.options.on_nan, report_, observer_, outcomes_))
            write_later(frame, open.number, open.begin);
    }

    void report_frame(const FrameRun::Rendered& frame, Clock::time_point begin) {
        const RunOptions& run = setup_.options;
        const int number = frame.capture->header.frame;
        if (run.trace) trace_frame(*run.trace, number, begin, frame.result->times);
        report_result(frame.capture->header, *frame.result, !any_rendered_, run, observer_);
        any_rendered_ = true;
        if (observer_.frame_differs) std::ranges::for_each(frame.differences, observer_.frame_differs);
        for (const ObjectSighting& sighting : loader_.objects().take_sightings())
            if (observer_.object_seen) observer_.object_seen(sighting);
        add_times(report_.passes, frame.result->times);
        if (frame.result->telemetry) report_.telemetry.push_back(*frame.result->telemetry);
    }

    /// A pipe takes frames in their order.
    std::size_t most_writes() const {
        return setup_.outputs.stream ? 1 : std::size_t(loader_.frames_ahead());
    }

    /// The files of the frame are written while the next ones are rendered.
    void write_later(const FrameRun::Rendered& frame, int number, Clock::time_point begin) {
        OutputOptions outputs = setup_.outputs;
        outputs.renderer = report_.gl.renderer;
        if (setup_.hooks.fingerprint) outputs.fingerprint = setup_.hooks.fingerprint(number);
        const auto before = pending_.empty() ? std::shared_future<Written>() : pending_.back().files;
        const auto write = [frame, number, begin, before, outputs = std::move(outputs), &setup = setup_] {
            Written written = write_frame(setup, outputs, *frame.result, *frame.capture);
            if (before.valid()) before.wait();
            if (setup.hooks.frame_written)
                setup.hooks.frame_written(number, written.files.paths, milliseconds_since(begin) / 1000);
            return written;
        };
        pending_.push_back({number, std::async(std::launch::async, write).share(), frame.message});
    }

    /// Waits for the files of earlier frames until no more than `left` frames are being written, and reports
    /// them in their order.
    void finish_writes(std::size_t left = 0) {
        while (pending_.size() > left) {
            const PendingWrite oldest = std::move(pending_.front());
            pending_.pop_front();
            const auto start = Clock::now();
            const Written& written = oldest.files.get();
            report_.write_ms += milliseconds_since(start);
            report_.encode_ms += written.milliseconds;
            if (!written.files.warnings.empty()) note_non_finite(oldest.frame, report_);
            if (observer_.non_finite) std::ranges::for_each(written.files.warnings, observer_.non_finite);
            say_cut(written.files);
            outcomes_.done(oldest.frame, written.files.paths, oldest.message);
        }
    }

    /// Once a run.
    void say_cut(const WrittenFiles& files) {
        constexpr double kFewPixels = 0.01;  // highlights
        if (is_cut_said_ || files.share_cut <= kFewPixels || !observer_.light_cut) return;
        observer_.light_cut(
            "a PNG ends at 1, and more than 1 % of its pixels are brighter; a last step that makes "
            "display, as a tone mapper does, keeps them apart");
        is_cut_said_ = true;
    }

    const RunSetup& setup_;
    PipelineRenderer& renderer_;
    const RunObserver& observer_;
    RunReport report_;
    FrameLoader& loader_;
    FrameRun frame_run_;
    Outcomes outcomes_;
    std::function<void()> end_gl_;
    const gpu::Context& context_;
    const bool overlaps_;  // the next frame begins before the results of one are collected
    std::optional<OpenFrame> open_;
    std::deque<PendingWrite> pending_;
    bool any_rendered_ = false;
    bool is_cut_said_ = false;
};

}  // namespace

RunReport run_frames(const RunSetup& setup, const RunObserver& observer, const std::atomic<bool>& stop) {
    // Under a limit OpenGL comes before frames: it says how much it needs.
    if (address_space_left()) setup.context();
    FrameLoader loader(setup.sequence, setup.reader, setup.pipeline, setup.options,
                       roles_to_read(setup.pipeline, setup.outputs));
    gpu::Context& context = setup.context();
    std::optional<PipelineRenderer> renderer(std::in_place, context, setup.pipeline, setup.data_folder,
                                             setup.options.natives, setup.options.drawing);
    const auto end_gl = [&] {
        renderer.reset();
        if (setup.end_context) setup.end_context();
    };
    try {
        if (!setup.options.history_in.empty()) renderer->load_history(setup.options.history_in);
        RunReport report = FrameLoop(setup, context, *renderer, loader, observer, end_gl).run(stop);
        renderer.reset();
        NativeRegistry* const natives = setup.options.natives.registry;
        if (natives && report.is_whole()) natives->require_ends();
        return report;
    } catch (const std::exception& error) {
        if (renderer && is_out_of_memory(error)) context.abandon();  // before the renderer goes
        throw;
    }
}

}  // namespace aftershade
