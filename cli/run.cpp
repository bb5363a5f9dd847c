#include "framework/pipeline/run.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/batch_report.h"
#include "cli/command_line.h"
#include "cli/effect_options.h"
#include "cli/frame_gaps.h"
#include "cli/gl_options.h"
#include "cli/graph_file.h"
#include "cli/interrupt.h"
#include "cli/run_continuation.h"
#include "cli/run_options.h"
#include "cli/run_report.h"
#include "cli/run_workers.h"
#include "cli/telemetry_plot.h"
#include "cli/verbs.h"
#include "cli/watch.h"
#include "framework/capture/frame_range.h"
#include "framework/core/atomic_file.h"
#include "framework/core/cores.h"
#include "framework/core/data_path.h"
#include "framework/core/trace.h"
#include "framework/gpu/timer.h"
#include "framework/pipeline/look.h"
#include "framework/pipeline/output.h"

namespace aftershade::cli {

namespace {

/// The look and its effects as they are on disk now; a pipeline refers to the effects.
struct BoundLook {
    explicit BoundLook(EffectRegistry found) : effects(std::move(found)) {}
    EffectRegistry effects;
    std::optional<Look> look;
    Pipeline pipeline;
};

std::optional<Look> look_of(const RunArguments& options, Diagnostics& diagnostics) {
    const LookVariables variables = look_variables(options, diagnostics);
    if (options.look_folder.empty()) return read_look(options.look, diagnostics, variables);
    std::optional<Node> node = read_document(options.look, diagnostics);
    if (!node) return std::nullopt;
    const std::filesystem::path name = std::filesystem::path(options.look).filename();
    node->place.file = (std::filesystem::path(options.look_folder) / name).string();
    return parse_look(*node, diagnostics, variables);
}

std::unique_ptr<BoundLook> bind_look(const RunArguments& options, Diagnostics& diagnostics) {
    auto bound = std::make_unique<BoundLook>(find_effects(options.effect_paths, diagnostics));
    bound->look = look_of(options, diagnostics);
    PipelineOptions pipeline = options.pipeline;
    for (std::string& tap : pipeline.taps) tap = tap.substr(0, tap.find('='));  // the files are the output's
    if (bound->look) bound->pipeline = bind_pipeline(*bound->look, bound->effects, pipeline, diagnostics);
    return bound;
}

/// What stays as it is while a look is being worked on.
struct RunSession {
    const RunArguments& arguments;
    StatusWriter& status;
    Sequence& sequence;
    const CaptureReader& reader;
    gpu::Context& context;
    RunOptions run;
    OutputOptions outputs;
    ProgressStyle progress;
};

/// What is written once, after the frames.
void write_extras(const RunArguments& arguments, const RunReport& report) {
    if (!arguments.graph.empty()) write_graph(arguments.graph, report.graph_dot);
    if (!arguments.telemetry_plot.empty())
        write_text_file(
            arguments.telemetry_plot,
            telemetry_plot(report.telemetry, std::filesystem::path(arguments.look).filename().string()));
}

/// What --report has of a run in this process, also of one that an error ends.
class ReportFile {
public:
    explicit ReportFile(const RunSession& session) : session_(session) {}
    ~ReportFile() {
        if (session_.arguments.jobs.report.empty()) return;
        try {
            const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start_;
            write_text_file(session_.arguments.jobs.report,
                            report_json({session_.arguments.look, session_.arguments.capture.capture,
                                         frame_events(session_.run, outcomes_), taken.count(), code_}));
        } catch (const Error& error) {
            std::cerr << error.what() << "\n";
        }
    }
    ReportFile(const ReportFile&) = delete;
    ReportFile& operator=(const ReportFile&) = delete;

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
        return observer;
    }
    void ended(ExitCode code) { code_ = code; }

private:
    const RunSession& session_;
    std::vector<FrameOutcome> outcomes_;
    ExitCode code_ = ExitCode::effect;  // of an error
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

ExitCode render(const RunSession& session, const Pipeline& pipeline, const std::atomic<bool>& stop) {
    Trace trace;
    RunOptions settings = session.run;
    if (!session.arguments.trace.empty()) settings.trace = &trace;
    RunReporter reporter(session.progress, int(session.run.frames.size()) - session.run.warmup_frames);
    ReportFile report_file(session);
    const RunReport report = run_frames(
        {session.context, pipeline, session.sequence, session.reader, settings, session.outputs, data_path()},
        report_file.watched(reporter.observer()), stop);
    report_file.ended(report.exit_code());
    const gpu::ContextInfo& gl = session.context.info();
    if (session.progress == ProgressStyle::plain || session.progress == ProgressStyle::terminal)
        std::cerr << gpu::backend_name(gl.backend) << ": " << gl.renderer << ", " << gl.version << "\n";
    reporter.print_summary(report, gpu::Timer::clock_name(session.context));
    if (report.interrupted && !session.arguments.watch)
        std::cerr << continuation_text(own_arguments(), session.run, report);
    if (settings.trace) write_text_file(session.arguments.trace, trace.json());
    write_extras(session.arguments, report);
    return report.exit_code();
}

/// A look with the state of its files from before they were read, so that no later save is missed.
struct WatchedLook {
    std::unique_ptr<BoundLook> bound;
    FileWatch files;
};

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

/// Renders again whenever a file of the look changes, until it is interrupted. Faults are printed, and waited
/// out. The sequence takes the names of objects from each look.
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
            render(session, look.bound->pipeline, stop);
        } catch (const Error& error) {
            std::cerr << error.what() << "\n";
            continue;
        }
        const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
        std::cerr << "made anew in " << int(taken.count()) << " ms\n";
    }
    return ExitCode::interrupted;
}

void require_first_frame(const Sequence& sequence, const CaptureReader& reader, const Pipeline& pipeline) {
    if (sequence.frames.size() == 1)
        require_capture_roles(pipeline, reader.read_header(sequence.file_number(sequence.frames.front())));
}

ExitCode explain(const Sequence& sequence, const CaptureReader& reader, const Pipeline& pipeline) {
    const Capture capture =
        reader.read(sequence.file_number(sequence.frames.front()), pipeline.capture_roles());
    FrameInputs frame;
    frame.capture = &capture;
    std::cout << explain_params(pipeline, frame);
    return ExitCode::done;
}

/// What would fail after the frames fails before them.
void prepare_outputs(const RunArguments& options, const OutputOptions& outputs, const Sequence& sequence) {
    require_graph_writer(options.graph);
    prepare_output_folders(outputs, sequence);
    for (const std::string* file : {&options.history_out, &options.graph, &options.telemetry_plot,
                                    &options.trace, &options.jobs.report})
        prepare_output_folder(*file);
}

/// The frames of this process and its workers.
struct FrameShare {
    JobFrames run;
    int workers = 1;
};

FrameShare share_of_frames(const RunArguments& options, const Pipeline& pipeline, const Sequence& sequence,
                           Diagnostics& diagnostics) {
    FrameShare share;
    if (options.jobs.is_worker()) {
        share.run.frames = parse_frame_range(options.jobs.worker_frames).value_or(std::vector<int>{});
        share.run.lead_frames = options.jobs.worker_warmup_frames;
        return share;
    }
    share.run = job_frames(options.jobs, pipeline, sequence, !options.history_in.empty(), diagnostics);
    if (!options.jobs.chunk.empty()) {
        const auto chunk = parse_chunk(
            options.jobs.chunk, [](const char* name) { return std::getenv(name); }, diagnostics);
        JobPiece piece = chunk_of(share.run, chunk.value_or(Chunk{}).index, chunk.value_or(Chunk{}).count);
        share.run.frames = std::move(piece.frames);
        share.run.lead_frames = piece.warmup_frames;
    }
    share.workers = worker_count(options.jobs, share.run, diagnostics);
    return share;
}

/// Renders in this process.
ExitCode run_here(const RunArguments& options, const RunSession& session, std::unique_ptr<BoundLook> bound,
                  std::optional<WatchedLook> watched, const std::atomic<bool>& stop) {
    const std::string lost =
        session.run.warmup_frames > 0 || options.jobs.is_worker()
            ? ""
            : lost_history_text(bound->pipeline, session.sequence, session.reader, session.run);
    if (!lost.empty()) std::cerr << "aftershade: warning: " << lost << "\n";
    const ExitCode code = render(session, bound->pipeline, stop);
    if (!options.watch) return code;
    watched->bound = std::move(bound);
    return watch(session, std::move(*watched), stop);
}

ExitCode run(const RunArguments& options) {
    const std::atomic<bool>& stop = watch_for_interrupt();

    // Everything that the user wrote is checked, and every fault listed, before any work starts.
    Diagnostics diagnostics;
    const gpu::Backend backend = chosen_backend(options.backend);
    const ProgressStyle progress = parse_progress(options.progress);
    std::optional<WatchedLook> watched;
    if (Diagnostics faults; options.watch && (watched = bind_watched(options, faults))) diagnostics = faults;
    auto bound = watched ? std::move(watched->bound) : bind_look(options, diagnostics);
    std::vector<Profile> profiles = load_profiles(options.capture.profile_paths, diagnostics);
    std::optional<Sequence> sequence = find_sequence(options.capture, profiles, diagnostics);
    if (sequence) sequence->object_names = bound->pipeline.object_names();
    OutputOptions outputs = output_options(options);
    RunOptions settings = run_options(options, diagnostics);
    if (sequence) add_missing_frames(options.capture, settings.missing, *sequence, diagnostics);
    check_outputs(outputs, sequence.value_or(Sequence{}), diagnostics);
    check_worker_options(options, diagnostics);
    const FrameShare share =
        sequence ? share_of_frames(options, bound->pipeline, *sequence, diagnostics) : FrameShare{};
    stop_at_errors(diagnostics);
    diagnostics.print(std::cerr);

    const CaptureReader reader(*sequence, std::move(profiles), options.capture.limits);
    if (options.explain) return explain(*sequence, reader, bound->pipeline);
    // A lone frame that cannot be read is reported before a context is made.
    require_first_frame(*sequence, reader, bound->pipeline);
    if (share.run.count() == 0) {
        std::cerr << "--chunk " << options.jobs.chunk
                  << ": no frames; the sequence has fewer frames than chunks\n";
        return ExitCode::done;
    }

    prepare_outputs(options, outputs, *sequence);
    if (options.jobs.wants_workers())
        return run_by_workers(options, share.run, share.workers, progress, stop);
    if (const auto code = run_in_worker(options.plugins, bound->pipeline, stop)) return *code;

    set_exr_threads(options.jobs.worker_threads > 0 ? options.jobs.worker_threads : allotted_cores());
    StatusWriter status;
    NativeRegistry natives(native_search_path({options.plugins.paths.begin(), options.plugins.paths.end()}),
                           shipped_native_libraries(), &status);
    gpu::Context context(backend);
    outputs.renderer = context.info().renderer;
    settings.frames = share.run.frames;
    settings.warmup_frames = share.run.lead_frames;
    settings.natives = {&natives, &status};
    const RunSession session{options, status, *sequence, reader, context, settings, outputs, progress};
    return run_here(options, session, std::move(bound), std::move(watched), stop);
}

}  // namespace

Verb add_run(CLI::App& app) {
    auto options = std::make_shared<RunArguments>();
    add_run_options(app, *options);
    return [options] { return run(*options); };
}

}  // namespace aftershade::cli
