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
        auto found = std::find_if(passes.begin(), passes.end(), [&](const auto& p) { return p.pass == time.pass; });
        if (found == passes.end()) found = passes.insert(passes.end(), {time.pass, 0, time.milliseconds, 0, 0});
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

}  // namespace

ExitCode RunReport::exit_code() const {
    if (interrupted) return ExitCode::interrupted;
    if (failures.empty()) return ExitCode::done;
    return frames_done > 0 ? ExitCode::partial : ExitCode::capture;
}

RunReport run_frames(gpu::Context& context, const Pipeline& pipeline, const CaptureReader& reader,
                     const std::vector<int>& frames, const OutputOptions& options,
                     const std::filesystem::path& data_folder, const RunObserver& observer,
                     const std::atomic<bool>& stop) {
    RunReport report;
    const auto start = Clock::now();
    const std::vector<std::string> result_roles = wanted_roles(options);
    std::vector<std::string> capture_roles = pipeline.capture_roles();
    for (const std::string& role : options.roles)
        if (std::find(capture_roles.begin(), capture_roles.end(), role) == capture_roles.end()) capture_roles.push_back(role);
    const auto read = [&](int frame) {
        Capture capture = reader.read(frame, capture_roles);
        require_capture_roles(pipeline, capture.header);
        return capture;
    };

    PipelineRenderer renderer(context, pipeline, data_folder);
    std::future<Written> pending_write;
    std::future<Capture> next = std::async(std::launch::async, read, frames.front());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const auto wait_start = Clock::now();
        std::shared_ptr<const Capture> capture;
        try {
            capture = std::make_shared<const Capture>(next.get());
        } catch (const Error& error) {
            if (error.exit_code() != ExitCode::capture) throw;
            report.failures.emplace_back(error.what());
            if (observer.frame_failed) observer.frame_failed(error.what());
        }
        report.read_ms += milliseconds_since(wait_start);
        report.interrupted = stop;
        if (report.interrupted) break;
        if (i + 1 < frames.size()) next = std::async(std::launch::async, read, frames[i + 1]);
        if (!capture) continue;
        if (observer.frame_started) observer.frame_started(capture->header);
        auto result = std::make_shared<const FrameResult>(renderer.render(*capture, result_roles, true));
        add_times(report.passes, result->times);
        finish_write(pending_write, report, observer);
        pending_write = std::async(std::launch::async, [capture, result, &options] {
            return write_outputs(options, *result, *capture);
        });
    }
    finish_write(pending_write, report, observer);
    report.wall_ms = milliseconds_since(start);
    return report;
}

}  // namespace aftershade
