#include "framework/pipeline/run.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <memory>
#include <utility>

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

/// Reads one frame ahead of the one that is being worked on.
class FrameLoader {
public:
    FrameLoader(const CaptureReader& reader, const Pipeline& pipeline, const RunOptions& run,
                std::vector<std::string> roles)
        : reader_(reader), pipeline_(pipeline), run_(run), roles_(std::move(roles)) {
        prefetch(0);
    }

    bool is_missing(std::size_t index) const { return !reader_.has_frame(run_.frames[index]); }

    bool can_hold() const { return last_ != nullptr; }

    /// Throws what reading threw.
    std::shared_ptr<const Capture> take(std::size_t index) {
        if (is_missing(index) && run_.missing == MissingFrame::hold && last_) {
            auto held = std::make_shared<Capture>(*last_);
            held->header.frame = run_.frames[index];
            prefetch(index + 1);
            return held;
        }
        std::future<Capture> current = std::move(next_);
        current.wait();
        prefetch(index + 1);
        last_ = std::make_shared<const Capture>(current.get());
        return last_;
    }

    void skip(std::size_t index) { prefetch(index + 1); }

private:
    void prefetch(std::size_t index) {
        if (index >= run_.frames.size()) return;
        next_ = std::async(std::launch::async, [this, frame = run_.frames[index]] {
            Capture capture = reader_.read(frame, roles_);
            require_capture_roles(pipeline_, capture.header);
            return capture;
        });
    }

    const CaptureReader& reader_;
    const Pipeline& pipeline_;
    const RunOptions& run_;
    std::vector<std::string> roles_;
    std::shared_ptr<const Capture> last_;
    std::future<Capture> next_;
};

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
    return frames_done > 0 ? ExitCode::partial : ExitCode::capture;
}

RunReport run_frames(gpu::Context& context, const Pipeline& pipeline, const CaptureReader& reader,
                     const RunOptions& run, const OutputOptions& outputs,
                     const std::filesystem::path& data_folder, const RunObserver& observer,
                     const std::atomic<bool>& stop) {
    RunReport report;
    const auto start = Clock::now();
    const std::vector<std::string> result_roles = wanted_roles(outputs);
    PipelineRenderer renderer(context, pipeline, data_folder);
    renderer.set_audit(run.audit);
    FrameLoader loader(reader, pipeline, run, roles_to_read(pipeline, outputs));
    std::future<Written> pending_write;
    for (std::size_t i = 0; i < run.frames.size(); ++i) {
        report.interrupted = stop;
        if (report.interrupted) break;
        const bool missing = run.missing != MissingFrame::error && loader.is_missing(i);
        const bool is_told = run.missing == MissingFrame::skip || loader.can_hold();
        if (missing && is_told && observer.frame_missing)
            observer.frame_missing(run.frames[i], run.missing == MissingFrame::skip ? "skipped" : "held");
        if (missing && run.missing == MissingFrame::skip) {
            ++report.frames_skipped;
            loader.skip(i);
            continue;
        }
        const auto wait_start = Clock::now();
        std::shared_ptr<const Capture> capture;
        try {
            capture = loader.take(i);
        } catch (const Error& error) {
            if (error.exit_code() != ExitCode::capture) throw;
            report.failures.emplace_back(error.what());
            if (observer.frame_failed) observer.frame_failed(error.what());
        }
        report.read_ms += milliseconds_since(wait_start);
        if (!capture) continue;
        if (observer.frame_started) observer.frame_started(*capture);
        auto result = std::make_shared<const FrameResult>(renderer.render(*capture, result_roles, true));
        if (run.audit && observer.frame_audited) observer.frame_audited(capture->header, result->audit);
        add_times(report.passes, result->times);
        finish_write(pending_write, report, observer);
        pending_write = std::async(std::launch::async, [capture, result, &outputs, &reader] {
            return write_outputs(outputs, *result, *capture, reader);
        });
    }
    finish_write(pending_write, report, observer);
    report.wall_ms = milliseconds_since(start);
    return report;
}

}  // namespace aftershade
