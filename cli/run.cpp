#include "framework/pipeline/run.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "cli/gl_options.h"
#include "cli/interrupt.h"
#include "cli/run_report.h"
#include "cli/verbs.h"
#include "framework/core/data_path.h"
#include "framework/gpu/timer.h"
#include "framework/pipeline/look.h"

namespace aftershade::cli {

namespace {

struct RunOptions {
    std::string look;
    std::string capture;
    std::vector<std::string> outputs;
    std::vector<std::string> roles;
    std::vector<std::string> effect_paths;
    std::string frames;
    std::string profile;
    std::string pixel_type = "half";
    std::string backend;
    std::string progress = "auto";
    PipelineOptions pipeline;
    ReadLimits limits;
};

void add_options(CLI::App& app, RunOptions& options) {
    app.add_option("look", options.look, "The look: a JSON file of effects in order")->required();
    app.add_option("capture", options.capture, "capture.json, an EXR file, or a pattern such as frame_####.exr")->required();
    app.add_option("-o,--output", options.outputs, "Output file or pattern (.exr, .png); repeatable")
        ->required()
        ->allow_extra_args(false);
    app.add_option("--set", options.pipeline.sets, "step.param=value, above the look's own; repeatable")
        ->allow_extra_args(false);
    app.add_option("--tap", options.pipeline.taps, "step.texture to write beside the first output; repeatable")
        ->allow_extra_args(false);
    app.add_option("--frames", options.frames, "Frames to run, such as 1-100x2,120");
    app.add_option("--profile", options.profile, "Conventions of the capture's producer (default: the capture's, else auto)");
    app.add_option("--output-roles", options.roles, "Roles in EXR outputs (default: color)")->delimiter(',');
    app.add_option("--pixel-type", options.pixel_type, "half or float, for roles that are half by default")
        ->check(CLI::IsMember({"half", "float"}));
    app.add_option("--effect-path", options.effect_paths, "Folder of effects, searched before the shipped ones; repeatable")
        ->allow_extra_args(false);
    app.add_option("--max-size", options.limits.max_side_px, "Refuse images with a side above this, px")
        ->check(CLI::Range(1, 65536))
        ->capture_default_str();
    app.add_option("--max-image-bytes", options.limits.max_image_bytes, "Refuse images of more bytes than this")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--progress", options.progress, "auto, none or plain")->capture_default_str();
    add_backend_option(app, options.backend);
}

/// Throws Error(ExitCode::usage) with every fault collected so far.
void stop_at_errors(const Diagnostics& diagnostics) {
    if (!diagnostics.has_errors()) return;
    diagnostics.print(std::cerr);
    throw Error(ExitCode::usage, std::to_string(diagnostics.error_count()) +
                                     (diagnostics.error_count() == 1 ? " error" : " errors") + "; nothing was run");
}

void choose_frames(const RunOptions& options, Sequence& sequence, Diagnostics& diagnostics) {
    if (options.frames.empty()) return;
    const Place place{"--frames " + options.frames};
    const auto frames = parse_frame_range(options.frames);
    if (!frames) {
        diagnostics.error(place, "not a frame range such as 1-100x2,120");
        return;
    }
    // With a range of its own, the capture says which frames there are; else the files on disk do, when they are read.
    for (const int frame : *frames)
        if (std::find(sequence.frames.begin(), sequence.frames.end(), frame) == sequence.frames.end()) {
            diagnostics.error(place, "the capture has no frame " + std::to_string(frame));
            return;
        }
    sequence.frames = *frames;
}

ExitCode run(const RunOptions& options) {
    const std::filesystem::path data = data_path();
    std::vector<std::filesystem::path> effect_folders(options.effect_paths.begin(), options.effect_paths.end());
    effect_folders.push_back(data / "effects");

    // Everything that the user wrote is checked, and every fault listed, before any work starts.
    Diagnostics diagnostics;
    const gpu::Backend backend = chosen_backend(options.backend);
    const ProgressStyle progress = parse_progress(options.progress);
    EffectRegistry effects(effect_folders);
    const auto look = read_look(options.look, diagnostics);
    Pipeline pipeline;
    if (look) pipeline = compile_pipeline(*look, effects, options.pipeline, diagnostics);
    std::vector<Profile> profiles = read_profiles(data / "profiles", diagnostics);
    auto sequence = open_sequence(options.capture, diagnostics);
    OutputOptions outputs{options.outputs, {"color"}, PixelType::half, options.look, ""};
    if (!options.roles.empty()) outputs.roles = options.roles;
    if (options.pixel_type == "float") outputs.color_type = PixelType::float32;
    if (sequence) {
        if (!options.profile.empty()) sequence->profile = options.profile;
        choose_frames(options, *sequence, diagnostics);
        check_outputs(outputs, *sequence, diagnostics);
    }
    stop_at_errors(diagnostics);
    diagnostics.print(std::cerr);

    const CaptureReader reader(*sequence, std::move(profiles), options.limits);
    // A lone frame that cannot be read is told of before a context is made.
    if (sequence->frames.size() == 1) require_capture_roles(pipeline, reader.read_header(sequence->frames.front()));

    set_exr_threads(int(std::thread::hardware_concurrency()));
    gpu::Context context(backend);
    outputs.renderer = context.info().renderer;
    RunReporter reporter(progress, int(sequence->frames.size()));
    const RunReport report = run_frames(context, pipeline, reader, sequence->frames, outputs, data, reporter.observer(),
                                        watch_for_interrupt());
    if (progress != ProgressStyle::none)
        std::cerr << gpu::backend_name(context.info().backend) << ": " << context.info().renderer << ", "
                  << context.info().version << "\n";
    reporter.print_summary(report, gpu::Timer::clock_name(context));
    return report.exit_code();
}

}  // namespace

Verb add_run(CLI::App& app) {
    auto options = std::make_shared<RunOptions>();
    add_options(app, *options);
    return [options] { return run(*options); };
}

}  // namespace aftershade::cli
