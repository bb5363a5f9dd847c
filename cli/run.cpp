#include "framework/pipeline/run.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/capture_options.h"
#include "cli/effect_options.h"
#include "cli/gl_options.h"
#include "cli/interrupt.h"
#include "cli/plugin_options.h"
#include "cli/render_options.h"
#include "cli/run_report.h"
#include "cli/telemetry_plot.h"
#include "cli/verbs.h"
#include "cli/watch.h"
#include "framework/core/atomic_file.h"
#include "framework/core/data_path.h"
#include "framework/gpu/timer.h"
#include "framework/pipeline/look.h"

namespace aftershade::cli {

namespace {

struct RunArguments {
    std::string look;
    std::string look_folder;
    std::vector<std::string> outputs;
    std::vector<std::string> roles;
    std::vector<std::string> effect_paths;
    std::string pixel_type = "half";
    std::string backend;
    std::string progress = "auto";
    std::string missing = "error";
    std::string crop = "data";
    std::string compression = "zip";
    bool keep_channels = false;
    bool audit = false;
    bool explain = false;
    bool watch = false;
    std::string telemetry;
    std::string telemetry_plot;
    PipelineOptions pipeline;
    CaptureOptions capture;
    RenderOptions render;
    PluginOptions plugins;
};

void add_options(CLI::App& app, RunArguments& options) {
    app.add_option("look", options.look, "The look: a JSON file of effects in order")->required();
    add_capture_argument(app, options.capture);
    app.add_option("-o,--output", options.outputs, "Output file or pattern (.exr, .png); repeatable")
        ->required()
        ->allow_extra_args(false);
    app.add_option("--set", options.pipeline.sets, "step.param=value, above the look's own; repeatable")
        ->allow_extra_args(false);
    app.add_option(
           "--tap", options.pipeline.taps,
           "step.texture to write as EXR beside the first output, or step.texture=FILE (.exr, or .png "
           "in false colour); repeatable")
        ->allow_extra_args(false);
    add_capture_options(app, options.capture, "Frames to run, such as 1-100x2,120");
    app.add_option("--output-roles", options.roles, "Roles in EXR outputs (default: color)")->delimiter(',');
    app.add_option("--pixel-type", options.pixel_type, "half or float, for roles that are half by default")
        ->check(CLI::IsMember({"half", "float"}));
    app.add_flag(
        "--keep-channels", options.keep_channels,
        "EXR: every channel of the source too, bit for bit but for those of roles that a step changed");
    app.add_option("--crop", options.crop, "EXR: data (the windows as they are) or display (its pixels only)")
        ->check(CLI::IsMember({"data", "display"}))
        ->capture_default_str();
    app.add_option("--compression", options.compression,
                   "EXR: none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa or dwab")
        ->capture_default_str();
    app.add_option("--missing", options.missing,
                   "A frame whose file is not there: error, skip, or hold the last one")
        ->check(CLI::IsMember({"error", "skip", "hold"}))
        ->capture_default_str();
    app.add_flag("--explain", options.explain,
                 "Print every parameter's value and where it is from, and run nothing");
    app.add_flag("--audit", options.audit,
                 "Tell which pass first writes NaN or infinite values, where and how many; slow");
    app.add_option(
        "--telemetry", options.telemetry,
        "Write each frame's numbers: the effects' statistics, memory by format, time by pass (.json)");
    app.add_option("--telemetry-plot", options.telemetry_plot,
                   "Plot the effects' statistics over the frames (.svg)");
    app.add_option("--look-folder", options.look_folder,
                   "Folder that files named in the look lie in (default: the look's own)");
    add_effect_path_option(app, options.effect_paths);
    app.add_option("--progress", options.progress, "auto, none or plain")->capture_default_str();
    app.add_flag("--watch", options.watch,
                 "Stay, and render again whenever the look, a manifest or a shader changes");
    add_plugin_options(app, options.plugins);
    add_render_options(app, options.render);
    add_backend_option(app, options.backend);
}

OutputOptions output_options(const RunArguments& options) {
    OutputOptions outputs;
    outputs.patterns = options.outputs;
    if (!options.roles.empty()) outputs.roles = options.roles;
    if (options.pixel_type == "float") outputs.color_type = PixelType::float32;
    outputs.keep_channels = options.keep_channels;
    outputs.crop_to_display = options.crop == "display";
    outputs.compression = options.compression;
    outputs.look = options.look;
    outputs.telemetry = options.telemetry;
    for (const std::string& tap : options.pipeline.taps)
        if (const std::size_t equals = tap.find('='); equals != std::string::npos)
            outputs.tap_patterns[tap.substr(0, equals)] = tap.substr(equals + 1);
    return outputs;
}

/// The look and its effects as they are on disk now; a pipeline refers to the effects.
struct BoundLook {
    explicit BoundLook(EffectRegistry found) : effects(std::move(found)) {}
    EffectRegistry effects;
    std::optional<Look> look;
    Pipeline pipeline;
};

std::optional<Look> look_of(const RunArguments& options, Diagnostics& diagnostics) {
    const LookVariables variables = parse_variables(options.render, diagnostics);
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
    if (bound->look) bound->pipeline = compile_pipeline(*bound->look, bound->effects, pipeline, diagnostics);
    return bound;
}

/// What stays as it is while a look is being worked on.
struct Job {
    const RunArguments& arguments;
    const Sequence& sequence;
    const CaptureReader& reader;
    gpu::Context& context;
    RunOptions run;
    OutputOptions outputs;
    ProgressStyle progress;
};

ExitCode render(const Job& job, const Pipeline& pipeline, const std::atomic<bool>& stop) {
    RunReporter reporter(job.progress, int(job.run.frames.size()));
    const RunReport report = run_frames(job.context, pipeline, job.sequence, job.reader, job.run, job.outputs,
                                        data_path(), reporter.observer(), stop);
    if (!job.arguments.render.graph.empty()) write_graph(job.arguments.render.graph, report.graph_dot);
    if (!job.arguments.telemetry_plot.empty())
        write_text_file(
            job.arguments.telemetry_plot,
            telemetry_plot(report.telemetry, std::filesystem::path(job.arguments.look).filename().string()));
    const gpu::ContextInfo& gl = job.context.info();
    if (job.progress != ProgressStyle::none)
        std::cerr << gpu::backend_name(gl.backend) << ": " << gl.renderer << ", " << gl.version << "\n";
    reporter.print_summary(report, gpu::Timer::clock_name(job.context));
    return report.exit_code();
}

/// Renders again whenever a file of the look changes, until it is interrupted. Faults are told, and waited
/// out.
ExitCode watch(const Job& job, std::unique_ptr<BoundLook> bound, const std::atomic<bool>& stop) {
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
            auto now = bind_look(job.arguments, diagnostics);
            diagnostics.print(std::cerr);
            if (diagnostics.has_errors()) continue;
            bound = std::move(now);
            files = FileWatch(paths_to_watch(*bound->look, bound->pipeline, data));
            render(job, bound->pipeline, stop);
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

MissingFrame missing_frame(const std::string& word) {
    return word == "skip" ? MissingFrame::skip : word == "hold" ? MissingFrame::hold : MissingFrame::error;
}

ExitCode run(const RunArguments& options) {
    const std::atomic<bool>& stop = watch_for_interrupt();

    // Everything that the user wrote is checked, and every fault listed, before any work starts.
    Diagnostics diagnostics;
    const gpu::Backend backend = chosen_backend(options.backend);
    const ProgressStyle progress = parse_progress(options.progress);
    auto bound = bind_look(options, diagnostics);
    std::vector<Profile> profiles = load_profiles(options.capture.profile_paths, diagnostics);
    const std::optional<Sequence> sequence = find_sequence(options.capture, profiles, diagnostics);
    OutputOptions outputs = output_options(options);
    check_outputs(outputs, sequence.value_or(Sequence{}), diagnostics);
    RunOptions run_options;
    apply_render_options(options.render, run_options, diagnostics);
    if (options.keep_channels && changes_window(options.render))
        diagnostics.error({"--keep-channels"},
                          "keeps the source's channels, which --scale and --region change");
    if (!options.telemetry_plot.empty() && !options.telemetry_plot.ends_with(".svg"))
        diagnostics.error({"--telemetry-plot " + options.telemetry_plot}, "must end in .svg");
    stop_at_errors(diagnostics);
    diagnostics.print(std::cerr);

    const CaptureReader reader(*sequence, std::move(profiles), options.capture.limits);
    if (options.explain) return explain(*sequence, reader, bound->pipeline);
    // A lone frame that cannot be read is told of before a context is made.
    require_first_frame(*sequence, reader, bound->pipeline);

    require_output_folders(outputs, *sequence);
    require_output_folder(options.render.history_out);
    require_output_folder(options.render.graph);
    require_output_folder(options.telemetry_plot);
    if (const auto code = run_in_worker(options.plugins, bound->pipeline, stop)) return *code;

    set_exr_threads(int(std::thread::hardware_concurrency()));
    StatusWriter status;
    NativeRegistry natives(native_search_path({options.plugins.paths.begin(), options.plugins.paths.end()}),
                           shipped_native_libraries(), &status);
    gpu::Context context(backend);
    outputs.renderer = context.info().renderer;
    run_options.frames = sequence->frames;
    run_options.missing = missing_frame(options.missing);
    run_options.audit = options.audit;
    run_options.telemetry = !options.telemetry.empty() || !options.telemetry_plot.empty();
    run_options.natives = {&natives, &status};
    const Job job{options, *sequence, reader, context, run_options, outputs, progress};
    const ExitCode code = render(job, bound->pipeline, stop);
    return options.watch ? watch(job, std::move(bound), stop) : code;
}

}  // namespace

Verb add_run(CLI::App& app) {
    auto options = std::make_shared<RunArguments>();
    add_options(app, *options);
    return [options] { return run(*options); };
}

}  // namespace aftershade::cli
