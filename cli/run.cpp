#include "framework/pipeline/run.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/effect_options.h"
#include "cli/gl_options.h"
#include "cli/graph_file.h"
#include "cli/interrupt.h"
#include "cli/run_options.h"
#include "cli/run_report.h"
#include "cli/telemetry_plot.h"
#include "cli/verbs.h"
#include "cli/watch.h"
#include "framework/core/atomic_file.h"
#include "framework/core/data_path.h"
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
    std::vector<std::filesystem::path> profiles;  ///< documents of those that frames may be read by
};

ExitCode render(const RunSession& session, const RunOptions& run, const Pipeline& pipeline,
                const std::atomic<bool>& stop, const RunHooks& hooks = {}) {
    RunReporter reporter(session.progress, int(run.frames.size()));
    const RunReport report = run_frames({session.context, pipeline, session.sequence, session.reader, run,
                                         session.outputs, data_path(), hooks},
                                        reporter.observer(), stop);
    if (!session.arguments.graph.empty()) write_graph(session.arguments.graph, report.graph_dot);
    if (!session.arguments.telemetry_plot.empty())
        write_text_file(session.arguments.telemetry_plot,
                        telemetry_plot(report.telemetry,
                                       std::filesystem::path(session.arguments.look).filename().string()));
    const gpu::ContextInfo& gl = session.context.info();
    if (session.progress != ProgressStyle::none)
        std::cerr << gpu::backend_name(gl.backend) << ": " << gl.renderer << ", " << gl.version << "\n";
    reporter.print_summary(report, gpu::Timer::clock_name(session.context));
    return report.exit_code();
}

/// Leaves out what is current.
ExitCode render_stale(const RunSession& session, const BoundLook& bound, const std::atomic<bool>& stop) {
    const RunArguments& arguments = session.arguments;
    const gpu::ContextInfo& gl = session.context.info();
    const FingerprintSource source{*bound.look,          bound.pipeline,
                                   session.sequence,     session.run,
                                   session.outputs,      capture_document(arguments.capture.capture),
                                   session.profiles,     gl.renderer + ", " + gl.version,
                                   data_path() / "glsl", session.run.natives.registry};
    ResumeNeeds needs;
    if (arguments.audit) needs.everything = "--audit";
    if (!arguments.telemetry_plot.empty()) needs.everything = "--telemetry-plot";
    needs.last_frame = !arguments.graph.empty();
    needs.says = session.progress != ProgressStyle::none;
    return run_resumable(arguments.resume, needs, source, session.reader,
                         [&](const RunOptions& run, const RunHooks& hooks) {
                             return render(session, run, bound.pipeline, stop, hooks);
                         });
}

/// Those that a frame may be read by: the one that was chosen, else all.
std::vector<std::filesystem::path> documents_of(const std::vector<Profile>& profiles,
                                                const Sequence& sequence) {
    std::vector<std::filesystem::path> documents;
    for (const Profile& profile : profiles)
        if (sequence.profile == "auto" || sequence.profile == profile.id) documents.push_back(profile.file);
    return documents;
}

/// Renders again whenever a file of the look changes, until it is interrupted. Faults are told, and waited
/// out.
ExitCode watch(const RunSession& session, std::unique_ptr<BoundLook> bound, const std::atomic<bool>& stop) {
    using namespace std::chrono_literals;
    const std::filesystem::path data = data_path();
    FileWatch files(paths_to_watch(*bound->look, bound->pipeline, data));
    std::cerr << "watching; interrupt to end\n";
    while (!stop) {
        std::this_thread::sleep_for(20ms);
        if (!files.changed()) continue;
        const auto start = std::chrono::steady_clock::now();
        try {
            Diagnostics diagnostics;
            auto now = bind_look(session.arguments, diagnostics);
            diagnostics.print(std::cerr);
            if (diagnostics.has_errors()) continue;
            bound = std::move(now);
            files = FileWatch(paths_to_watch(*bound->look, bound->pipeline, data));
            render(session, session.run, bound->pipeline, stop);
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

ExitCode run(const RunArguments& options) {
    const std::atomic<bool>& stop = watch_for_interrupt();

    // Everything that the user wrote is checked, and every fault listed, before any work starts.
    Diagnostics diagnostics;
    const gpu::Backend backend = chosen_backend(options.backend);
    const ProgressStyle progress = parse_progress(options.progress);
    auto bound = bind_look(options, diagnostics);
    std::vector<Profile> profiles = load_profiles(options.capture.profile_paths, diagnostics);
    std::optional<Sequence> sequence = find_sequence(options.capture, profiles, diagnostics);
    if (sequence) sequence->object_names = bound->pipeline.object_names();
    OutputOptions outputs = output_options(options);
    check_outputs(outputs, sequence.value_or(Sequence{}), diagnostics);
    RunOptions settings = run_options(options, diagnostics);
    stop_at_errors(diagnostics);
    diagnostics.print(std::cerr);

    const auto profile_documents = documents_of(profiles, *sequence);
    const CaptureReader reader(*sequence, std::move(profiles), options.capture.limits);
    if (options.explain) return explain(*sequence, reader, bound->pipeline);
    // A lone frame that cannot be read is told of before a context is made.
    require_first_frame(*sequence, reader, bound->pipeline);

    require_output_folders(outputs, *sequence);
    require_output_folder(options.history_out);
    require_output_folder(options.graph);
    require_output_folder(options.telemetry_plot);
    if (const auto code = run_in_worker(options.plugins, bound->pipeline, stop)) return *code;

    set_exr_threads(int(std::thread::hardware_concurrency()));
    StatusWriter status;
    NativeRegistry natives(native_search_path({options.plugins.paths.begin(), options.plugins.paths.end()}),
                           shipped_native_libraries(), &status);
    gpu::Context context(backend);
    outputs.renderer = context.info().renderer;
    settings.frames = sequence->frames;
    settings.natives = {&natives, &status};
    const RunSession session{options,  *sequence, reader,   context,
                             settings, outputs,   progress, profile_documents};
    const bool resumes = !options.watch && options.resume.keeps_journal(settings.frames.size());
    if (resumes || options.resume.dry_run) return render_stale(session, *bound, stop);
    const ExitCode code = render(session, session.run, bound->pipeline, stop);
    return options.watch ? watch(session, std::move(bound), stop) : code;
}

}  // namespace

Verb add_run(CLI::App& app) {
    auto options = std::make_shared<RunArguments>();
    add_run_options(app, *options);
    return [options] { return run(*options); };
}

}  // namespace aftershade::cli
