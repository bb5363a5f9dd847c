#include "cli/run_session.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <iostream>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cli/batch_report.h"
#include "cli/command_line.h"
#include "cli/exit_code.h"
#include "cli/gl_options.h"
#include "cli/graph_file.h"
#include "cli/plot.h"
#include "cli/run_continuation.h"
#include "framework/base/atomic_file.h"
#include "framework/base/data_path.h"
#include "framework/base/error.h"
#include "framework/base/memory_limit.h"
#include "framework/base/text.h"
#include "framework/gpu/device.h"
#include "framework/gpu/timer.h"
#include "framework/render/telemetry.h"
#include "framework/render/trace.h"

namespace aftershade::cli {

namespace {

// Telemetry of a sequence as line charts.

/// From 0, or from below it where values are, to a little above the largest.
std::array<double, 2> range_of(const std::vector<PlotLine>& lines) {
    double low = 0, high = 0;
    for (const PlotLine& line : lines)
        for (const auto& [x, y] : line.points) {
            low = std::min(low, y);
            high = std::max(high, y);
        }
    return {low, high > low ? high + 0.05 * (high - low) : low + 1};
}

PlotPanel panel_of(std::string title, std::array<double, 2> frames, std::vector<PlotLine> lines) {
    PlotPanel panel{std::move(title), "frame", frames, range_of(lines), false, {}};
    panel.lines = std::move(lines);
    return panel;
}

/// SVG: a panel for each statistic of each step, its mean and largest over the frames, and one for the time
/// of all passes. Frames without a statistic leave a gap.
std::string telemetry_plot(const std::vector<FrameTelemetry>& frames, const std::string& title) {
    std::array<double, 2> range{0, 1};
    if (!frames.empty()) range = {double(frames.front().frame), double(frames.back().frame)};
    if (range[0] == range[1]) ++range[1];
    std::set<std::pair<std::string, std::string>> names;
    for (const FrameTelemetry& frame : frames)
        for (const auto& [step, statistics] : frame.steps)
            for (const auto& [name, statistic] : statistics) names.emplace(step, name);
    std::vector<PlotPanel> panels;
    for (const auto& [step, name] : names) {
        PlotLine mean{"mean", {}}, most{"largest", {}};
        for (const FrameTelemetry& frame : frames) {
            const auto found = frame.steps.find(step);
            if (found == frame.steps.end() || !found->second.contains(name)) continue;
            const Statistic& statistic = found->second.at(name);
            if (statistic.count == 0) continue;
            mean.points.push_back({double(frame.frame), statistic.mean});
            most.points.push_back({double(frame.frame), statistic.max});
        }
        panels.push_back(panel_of(step + "." + name, range, {mean, most}));
    }
    PlotLine time{"sum", {}};
    for (const FrameTelemetry& frame : frames) {
        double sum = 0;
        for (const graph::PassTime& pass : frame.passes) sum += pass.milliseconds;
        time.points.push_back({double(frame.frame), sum});
    }
    panels.push_back(panel_of("all passes, ms", range, {time}));
    return plot_svg("Telemetry of " + title, "Mean and largest over the texels that count.", panels);
}

/// What is written once, after the frames.
void write_extras(const RunArguments& arguments, const RunReport& report) {
    if (!arguments.graph.empty()) write_graph(arguments.graph, report.graph_dot);
    if (!arguments.telemetry_plot.empty())
        write_text_file(
            arguments.telemetry_plot,
            telemetry_plot(report.telemetry, std::filesystem::path(arguments.look).filename().string()));
}

DrawnBy drawn_by(const gpu::ContextInfo& gl) {
    return {std::string(gpu::backend_name(gl.backend)) + ": " + gl.renderer + ", " + gl.version, gl.device,
            gl.hardware_fault};
}

/// What --report has of a run in this process, also of one that an error ends.
class ReportFile {
public:
    ReportFile(const RunSession& session, const std::vector<int>& current)
        : session_(session), current_(current) {}

    /// Does the work and writes the report of it. Throws what the work throws, and where the report of
    /// work without a fault cannot be written.
    ExitCode of(const std::function<ExitCode()>& work) {
        try {
            code_ = work();
        } catch (const std::exception& error) {
            code_ = exit_code_of(error);
            error_ = error.what();
            write();
            throw;
        }
        write();
        return code_;
    }

    /// Also says to the process that started this one, if any, where it is.
    RunObserver watched(RunObserver observer) {
        observer.frame_started = [this, started = observer.frame_started](const Capture& capture) {
            session_.status.write(WorkStatus{"", "", "", capture.header.frame});
            if (started) started(capture);
        };
        observer.frame_finished = [this](const FrameOutcome& outcome) {
            outcomes_.push_back(outcome);
            session_.status.write(frame_event(outcome));
        };
        observer.object_seen = [this](const ObjectSighting& sighting) { session_.status.write(sighting); };
        return observer;
    }
    RunReport run(const RunSetup& setup, const RunObserver& observer, const std::atomic<bool>& stop) {
        RunReport report = run_frames(setup, watched(observer), stop);
        report.frames_current = int(current_.size());
        if (!report.gl.renderer.empty()) session_.status.write(gl_ = drawn_by(report.gl));
        return report;
    }

private:
    /// Where it cannot, an earlier fault keeps its code.
    void write() const {
        if (session_.arguments.jobs.report.empty()) return;
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start_;
        try {
            write_text_file(session_.arguments.jobs.report,
                            report_json({session_.arguments.look, session_.arguments.capture.capture,
                                         frame_events(session_.run, outcomes_, current_), taken.count(),
                                         code_, gl_, error_}));
        } catch (const Error& error) {
            if (code_ == ExitCode::done) throw;
            std::cerr << printable_lines(error.what()) << "\n";
        }
    }

    const RunSession& session_;
    const std::vector<int>& current_;
    std::vector<FrameOutcome> outcomes_;
    ExitCode code_ = ExitCode::effect;
    DrawnBy gl_;
    std::string error_;  // its message
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

ExitCode render(const RunSession& session, const RunOptions& run, const Pipeline& pipeline,
                const std::atomic<bool>& stop, const RunHooks& hooks, const std::vector<int>& current) {
    Trace trace;
    RunOptions settings = run;
    if (!session.arguments.trace.empty()) settings.trace = &trace;
    RunReporter reporter(session.progress, int(run.frames.size()), run.warmup_frames,
                         session.arguments.verbose);
    ReportFile report_file(session, current);
    return report_file.of([&] {
        const RunReport report =
            report_file.run({session.context, pipeline, session.sequence, session.reader, settings,
                             session.outputs, data_path(), hooks, session.end_context},
                            reporter.observer(), stop);
        // Of workers, the process that started them says it once.
        if (!report.gl.hardware_fault.empty() && !session.arguments.jobs.is_worker() &&
            gpu::has_gpu_file("/"))
            reporter.warn(software_warning(report.gl.hardware_fault));
        // Of several workers each sees only a part of the frames.
        if (!session.arguments.jobs.is_worker())
            for (const std::string& warning : report.objects_unmatched) reporter.warn(warning);
        reporter.print_summary(report);
        if (session.outputs.stream && !report.failures.empty())
            std::cerr
                << "-o " << session.arguments.stream_output() << ": the stream ends before frame "
                << report.failures.front().frame
                << ", since a gap would shift the frames behind it; --missing hold repeats a frame where the "
                   "file of the next one is not there\n";
        if (settings.trace) write_text_file(session.arguments.trace, trace.json());
        write_extras(session.arguments, report);
        if (report.interrupted && !session.arguments.watch && !session.arguments.jobs.is_worker())
            print_interruption(
                session.progress, session.arguments,
                {report.frames_done + report.frames_current,
                 int(session.run.frames.size()) - session.run.warmup_frames, false, pipeline.has_history()});
        return exit_code_of(report);
    });
}

/// Which files there are to watch is known only after a look is bound, so it is bound twice. nullopt where
/// that fails; `diagnostics` says why.
std::optional<WatchedLook> bind_watched(const RunArguments& options, Diagnostics& diagnostics) {
    auto bound = bind_look(options, diagnostics);
    if (diagnostics.has_errors()) return std::nullopt;
    for (;;) {
        FileWatch files(paths_to_watch(*bound->look, bound->pipeline, data_path()));
        Diagnostics again;
        bound = bind_look(options, again);
        if (again.has_errors()) {
            diagnostics = std::move(again);
            return std::nullopt;
        }
        if (files.paths() == paths_to_watch(*bound->look, bound->pipeline, data_path()))
            return WatchedLook{std::move(bound), std::move(files)};
    }
}

namespace {

/// Frames that need no work, or are rendered only for those behind them.
std::vector<int> current_frames(const ResumableRun& resumable, const RunSession& session) {
    const auto& plan = resumable.plan();
    std::vector<int> frames;
    for (std::size_t i = std::size_t(session.run.warmup_frames); i < plan.size(); ++i)
        if (plan[i].action != FrameAction::write) frames.push_back(plan[i].frame);
    return frames;
}

}  // namespace

ExitCode render_stale(const RunSession& session, const BoundLook& bound, const std::atomic<bool>& stop) {
    const RunArguments& arguments = session.arguments;
    const gpu::ContextInfo& gl = session.context().info();
    const FingerprintSource source{*bound.look,          bound.pipeline,
                                   session.sequence,     session.run,
                                   session.outputs,      capture_document(arguments.capture.capture),
                                   session.profiles,     gl.renderer + ", " + gl.version,
                                   data_path() / "glsl", session.run.natives.registry};
    ResumeNeeds needs;
    needs.everything = arguments.needs_every_frame();
    needs.last_frame = !arguments.graph.empty();
    needs.says = session.progress != ProgressStyle::none;
    std::vector<int> current;
    needs.planned = [&](const ResumableRun& resumable) {
        current = current_frames(resumable, session);
        for (const int frame : current) session.status.write(FrameEvent{frame, "current", 0, ""});
    };
    bool is_rendered = arguments.resume.dry_run;
    const ExitCode code = run_resumable(arguments.resume, needs, source, session.reader,
                                        [&](const RunOptions& run, const RunHooks& hooks) {
                                            is_rendered = true;
                                            return render(session, run, bound.pipeline, stop, hooks, current);
                                        });
    return is_rendered ? code : ReportFile(session, current).of([code] { return code; });
}

ExitCode watch(const RunSession& session, WatchedLook look, const std::atomic<bool>& stop) {
    using namespace std::chrono_literals;
    std::cerr << "watching; interrupt to end\n";
    while (!stop) {
        std::this_thread::sleep_for(20ms);
        if (!look.files.changed()) continue;
        const auto start = std::chrono::steady_clock::now();
        try {
            Diagnostics diagnostics;
            auto now = bind_watched(session.arguments, diagnostics);
            diagnostics.print(std::cerr);
            if (!now) continue;
            look = std::move(*now);
            session.sequence.object_names = look.bound->pipeline.object_names();
            render(session, session.run, look.bound->pipeline, stop);
        } catch (const Error& error) {
            std::cerr << printable_lines(error.what()) << "\n";
            continue;
        }
        const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
        std::cerr << "re-rendered in " << int(taken.count()) << " ms\n";
    }
    return ExitCode::interrupted;
}

namespace fs = std::filesystem;

FileWatch::States FileWatch::look() const {
    States states;
    std::error_code failure;
    const auto add = [&](const fs::path& file) {
        states[file] = {fs::last_write_time(file, failure), fs::file_size(file, failure)};
    };
    for (const fs::path& path : paths_) {
        if (!fs::is_directory(path, failure)) add(path);
        else
            for (const auto& entry : fs::directory_iterator(path, failure))
                if (entry.is_regular_file(failure)) add(entry.path());
    }
    return states;
}

bool FileWatch::changed() {
    States now = look();
    const bool differs = now != seen_;
    seen_ = std::move(now);
    return differs;
}

std::vector<fs::path> paths_to_watch(const Look& look, const Pipeline& pipeline,
                                     const fs::path& data_folder) {
    std::vector<fs::path> paths = look.files;
    for (const PipelineStep& step : pipeline.steps) paths.push_back(step.manifest->folder);
    const fs::path glsl = data_folder / "glsl";
    paths.push_back(glsl);
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(glsl, failure))
        if (entry.is_directory(failure)) paths.push_back(entry.path());
    return paths;
}

}  // namespace aftershade::cli
