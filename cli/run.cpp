#include "framework/pipeline/run.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/command_line.h"
#include "cli/effect_options.h"
#include "cli/frame_gaps.h"
#include "cli/gl_options.h"
#include "cli/graph_file.h"
#include "cli/interrupt.h"
#include "cli/run_continuation.h"
#include "cli/run_options.h"
#include "cli/run_report.h"
#include "cli/telemetry_plot.h"
#include "cli/verbs.h"
#include "cli/watch.h"
#include "framework/core/atomic_file.h"
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
    const Sequence& sequence;
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

ExitCode render(const RunSession& session, const Pipeline& pipeline, const std::atomic<bool>& stop) {
    Trace trace;
    RunOptions settings = session.run;
    if (!session.arguments.trace.empty()) settings.trace = &trace;
    RunReporter reporter(session.progress, int(session.run.frames.size()));
    const RunReport report = run_frames(
        {session.context, pipeline, session.sequence, session.reader, settings, session.outputs, data_path()},
        reporter.observer(), stop);
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

/// Renders again whenever a file of the look changes, until it is interrupted. Faults are told, and waited
/// out.
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
    for (const std::string* file :
         {&options.history_out, &options.graph, &options.telemetry_plot, &options.trace})
        prepare_output_folder(*file);
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
    stop_at_errors(diagnostics);
    diagnostics.print(std::cerr);

    const CaptureReader reader(*sequence, std::move(profiles), options.capture.limits);
    if (options.explain) return explain(*sequence, reader, bound->pipeline);
    // A lone frame that cannot be read is told of before a context is made.
    require_first_frame(*sequence, reader, bound->pipeline);

    prepare_outputs(options, outputs, *sequence);
    if (const auto code = run_in_worker(options.plugins, bound->pipeline, stop)) return *code;

    set_exr_threads(int(std::thread::hardware_concurrency()));
    StatusWriter status;
    NativeRegistry natives(native_search_path({options.plugins.paths.begin(), options.plugins.paths.end()}),
                           shipped_native_libraries(), &status);
    gpu::Context context(backend);
    outputs.renderer = context.info().renderer;
    settings.frames = sequence->frames;
    settings.natives = {&natives, &status};
    if (const std::string lost = lost_history_text(bound->pipeline, *sequence, reader, settings);
        !lost.empty())
        std::cerr << "aftershade: warning: " << lost << "\n";
    const RunSession session{options, *sequence, reader, context, settings, outputs, progress};
    const ExitCode code = render(session, bound->pipeline, stop);
    if (!options.watch) return code;
    watched->bound = std::move(bound);
    return watch(session, std::move(*watched), stop);
}

}  // namespace

Verb add_run(CLI::App& app) {
    auto options = std::make_shared<RunArguments>();
    add_run_options(app, *options);
    return [options] { return run(*options); };
}

}  // namespace aftershade::cli
