#include "framework/pipeline/run.h"

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
#include "cli/render_options.h"
#include "cli/run_report.h"
#include "cli/verbs.h"
#include "framework/core/data_path.h"
#include "framework/gpu/timer.h"
#include "framework/pipeline/look.h"

namespace aftershade::cli {

namespace {

struct RunArguments {
    std::string look;
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
    PipelineOptions pipeline;
    CaptureOptions capture;
    RenderOptions render;
};

void add_options(CLI::App& app, RunArguments& options) {
    app.add_option("look", options.look, "The look: a JSON file of effects in order")->required();
    add_capture_argument(app, options.capture);
    app.add_option("-o,--output", options.outputs, "Output file or pattern (.exr, .png); repeatable")
        ->required()
        ->allow_extra_args(false);
    app.add_option("--set", options.pipeline.sets, "step.param=value, above the look's own; repeatable")
        ->allow_extra_args(false);
    app.add_option("--tap", options.pipeline.taps,
                   "step.texture to write beside the first output; repeatable")
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
    add_effect_path_option(app, options.effect_paths);
    app.add_option("--progress", options.progress, "auto, none or plain")->capture_default_str();
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
    return outputs;
}

ExitCode run(const RunArguments& options) {
    const std::atomic<bool>& stop = watch_for_interrupt();
    const std::filesystem::path data = data_path();

    // Everything that the user wrote is checked, and every fault listed, before any work starts.
    Diagnostics diagnostics;
    EffectRegistry effects = find_effects(options.effect_paths, diagnostics);
    const gpu::Backend backend = chosen_backend(options.backend);
    const ProgressStyle progress = parse_progress(options.progress);
    const auto look = read_look(options.look, diagnostics, parse_variables(options.render, diagnostics));
    Pipeline pipeline;
    if (look) pipeline = compile_pipeline(*look, effects, options.pipeline, diagnostics);
    std::vector<Profile> profiles = load_profiles(options.capture, diagnostics);
    const std::optional<Sequence> sequence = find_sequence(options.capture, profiles, diagnostics);
    OutputOptions outputs = output_options(options);
    check_outputs(outputs, sequence.value_or(Sequence{}), diagnostics);
    RunOptions run_options;
    apply_render_options(options.render, run_options, diagnostics);
    if (options.keep_channels && changes_window(options.render))
        diagnostics.error({"--keep-channels"},
                          "keeps the source's channels, which --scale and --region change");
    stop_at_errors(diagnostics);
    diagnostics.print(std::cerr);

    const CaptureReader reader(*sequence, std::move(profiles), options.capture.limits);
    if (options.explain) {
        const int file = sequence->file_number(sequence->frames.front());
        const Capture capture = reader.read(file, pipeline.capture_roles());
        FrameInputs frame;
        frame.capture = &capture;
        std::cout << explain_params(pipeline, frame);
        return ExitCode::done;
    }
    // A lone frame that cannot be read is told of before a context is made.
    if (sequence->frames.size() == 1)
        require_capture_roles(pipeline, reader.read_header(sequence->file_number(sequence->frames.front())));

    set_exr_threads(int(std::thread::hardware_concurrency()));
    gpu::Context context(backend);
    outputs.renderer = context.info().renderer;
    RunReporter reporter(progress, int(sequence->frames.size()));
    const MissingFrame missing = options.missing == "skip"   ? MissingFrame::skip
                                 : options.missing == "hold" ? MissingFrame::hold
                                                             : MissingFrame::error;
    run_options.frames = sequence->frames;
    run_options.missing = missing;
    run_options.audit = options.audit;
    const RunReport report = run_frames(context, pipeline, *sequence, reader, run_options, outputs, data,
                                        reporter.observer(), stop);
    if (!options.render.graph.empty()) write_graph(options.render.graph, report.graph_dot);
    if (progress != ProgressStyle::none)
        std::cerr << gpu::backend_name(context.info().backend) << ": " << context.info().renderer << ", "
                  << context.info().version << "\n";
    reporter.print_summary(report, gpu::Timer::clock_name(context));
    return report.exit_code();
}

}  // namespace

Verb add_run(CLI::App& app) {
    auto options = std::make_shared<RunArguments>();
    add_options(app, *options);
    return [options] { return run(*options); };
}

}  // namespace aftershade::cli
