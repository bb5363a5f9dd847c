#include "cli/run_arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>

#include "cli/effect_options.h"
#include "cli/gl_options.h"
#include "cli/stream_options.h"
#include "framework/document/units.h"
#include "framework/file/frame_stream.h"
#include "framework/render/draw_with.h"

namespace aftershade::cli {

namespace {

/// The n of "1/n", "1" or a decimal such as "0.5" that is one.
int parse_scale(const std::string& text) {
    constexpr int kMost = 64;
    for (int n = 1; n <= kMost; ++n)
        if (text == "1/" + std::to_string(n)) return n;
    const double value = parse_number(text).value_or(0);
    if (value < 1.0 / (2 * kMost) || value > 1) return 0;  // below, the quotient may be no int
    const auto n = int(std::lround(1 / value));
    return n <= kMost && std::abs(value * n - 1) < 1e-9 ? n : 0;
}

/// "x,y,w,h" as a window.
std::optional<Window> parse_region(const std::string& text) {
    int numbers[4] = {0, 0, 0, 0};
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    for (int i = 0; i < 4; ++i) {
        const auto [next, failure] = std::from_chars(at, end, numbers[i]);
        if (failure != std::errc{}) return std::nullopt;
        at = next;
        if (i < 3 && (at == end || *at++ != ',')) return std::nullopt;
    }
    if (at != end || numbers[2] < 1 || numbers[3] < 1) return std::nullopt;
    return Window{numbers[0], numbers[1], numbers[0] + numbers[2] - 1, numbers[1] + numbers[3] - 1};
}

MissingFrame missing_frame(const std::string& word) {
    return word == "skip" ? MissingFrame::skip : word == "hold" ? MissingFrame::hold : MissingFrame::error;
}

NanPolicy nan_policy(const std::string& word) {
    return word == "fail" ? NanPolicy::fail : word == "mend" ? NanPolicy::mend : NanPolicy::warn;
}

void add_look_options(CLI::App& app, RunArguments& options) {
    app.add_option("look", options.look, "The look: a JSON file of effects in order")->required();
    add_capture_argument(app, options.capture);
    app.add_option(
           "-o,--output", options.outputs,
           "Output file or pattern (.exr, .png), a video (.mp4, .mov, .mkv, .webm; needs ffmpeg), or - for "
           "standard output; repeatable")
        ->required()
        ->allow_extra_args(false);
    app.add_option("--set", options.pipeline.sets,
                   "STEP.PARAM=VALUE: override a value of the look; repeatable")
        ->allow_extra_args(false);
    app.add_option("--var", options.variables, "NAME=VALUE: override one of the look's \"vars\"; repeatable")
        ->allow_extra_args(false);
    app.add_option("--look-folder", options.look_folder,
                   "Resolve files named in the look in this folder (default: the look's own)");
    add_effect_path_option(app, options.effect_paths);
    add_ocio_option(app);
    app.add_flag("--watch", options.watch,
                 "Keep running, and render again whenever the look, a manifest or a shader changes");
    app.add_option("--progress", options.progress,
                   "Progress: auto, none, plain, json (one object per line, on stderr) or openjd "
                   "(Open Job Description, on stdout)")
        ->capture_default_str();
}

void add_fault_options(CLI::App& app, RunArguments& options) {
    app.add_option("--missing", options.missing,
                   "If a frame's file is missing: error, skip it, or hold the previous one")
        ->check(CLI::IsMember({"error", "skip", "hold"}))
        ->capture_default_str();
    app.add_option("--on-nan", options.on_nan,
                   "If a capture or an output has NaN or infinite pixels: warn, fail the frame, or mend: "
                   "replace them from the pixels around")
        ->check(CLI::IsMember({"warn", "fail", "mend"}))
        ->capture_default_str();
}

void add_output_options(CLI::App& app, RunArguments& options) {
    app.add_option("--tap", options.pipeline.taps,
                   "STEP.TEXTURE: write this intermediate as EXR next to the first output; "
                   "STEP.TEXTURE=FILE: write it there (.exr, or .png in false colour); repeatable")
        ->allow_extra_args(false);
    app.add_option("--scale", options.scale, "Render at 1/n of the size; values in px scale accordingly")
        ->capture_default_str();
    app.add_option("--region", options.region,
                   "X,Y,W,H: render only these px of the display window, at full scale");
    app.add_option(
           "--region-margin", options.region_margin_px,
           "Render this many px around the region instead of the margin that the effects need for the "
           "pixels of the whole frame; the margin is not written")
        ->check(CLI::Range(0, 16384));
    app.add_option("--output-roles", options.roles, "Roles in EXR outputs (default: color)")->delimiter(',');
    app.add_option("--pixel-type", options.pixel_type, "Type of roles that are half by default")
        ->check(CLI::IsMember({"half", "float"}));
    app.add_option(
           "--png-bits", options.png_bits,
           "Bits of a sample of PNG outputs: 8 or 16 (default: 16 for displays of PQ and HLG, else 8)")
        ->check(CLI::IsMember({8, 16}));
    app.add_flag(
        "--keep-channels", options.keep_channels,
        "EXR: also copy the source's channels bit for bit, except those of roles that a step changed");
    app.add_option("--crop", options.crop, "EXR: keep the data window, or crop to the display window")
        ->check(CLI::IsMember({"data", "display"}))
        ->capture_default_str();
    app.add_option(
           "--compression", options.compression,
           "EXR: none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa or dwab; zip:1 packs fastest, zip:9 most")
        ->capture_default_str();
}

void add_history_options(CLI::App& app, RunArguments& options) {
    app.add_option("--history-in", options.history_in,
                   "Continue from the history that a run over the preceding frames wrote");
    app.add_option("--history-out", options.history_out,
                   "Write the history after the last frame, for the next chunk of the sequence");
}

void add_diagnosis_options(CLI::App& app, RunArguments& options) {
    app.add_flag("--explain", options.explain,
                 "Print every parameter's value and its source, and run nothing");
    app.add_flag("-v,--verbose", options.verbose,
                 "Print the time of each pass and stage, and the memory of textures and buffers");
    app.add_flag("--audit", options.audit,
                 "Name the pass that first writes NaN or infinite values, with place and count; slow");
    app.add_flag("--apart", options.apart,
                 "Draw each pass by itself, also where passes could be fused: the time of each, slower");
    app.add_flag(
        "--plain", options.plain,
        "Draw without loads from images, fusion and compiling ahead (docs/llvmpipe.md): the same picture, "
        "slower; for faults of a driver");
    app.add_option("--telemetry", options.telemetry,
                   "Write each frame's statistics, memory by format and time by pass to this .json");
    app.add_option("--telemetry-plot", options.telemetry_plot,
                   "Plot the effects' statistics over the frames to this .svg");
    app.add_option("--graph", options.graph, "Draw the frame graph of the last frame: .dot or .svg");
    app.add_option("--trace", options.trace,
                   "Write a timeline to this .json, for chrome://tracing or ui.perfetto.dev");
}

}  // namespace

void add_run_options(CLI::App& app, RunArguments& options) {
    const auto begin_group = [&](const char* heading) { app.option_defaults()->group(heading); };
    add_look_options(app, options);
    begin_group("Capture");
    add_capture_options(app, options.capture, "Frames to run, such as 1-100x2,120");
    add_fault_options(app, options);
    begin_group("Output");
    add_output_options(app, options);
    add_stream_options(app, options.stream);
    add_resume_options(app, options.resume);
    begin_group("Workers and chunks of a sequence");
    add_job_options(app, options.jobs);
    add_history_options(app, options);
    begin_group("Diagnosis");
    add_diagnosis_options(app, options);
    begin_group("Machine, and code that is not shipped");
    add_gl_options(app, options.gl);
    app.add_option("--draw-with", options.draw_with,
                   "Draw with fragment shaders, or with compute shaders where they can give the same "
                   "picture, which data-centre GPUs run faster; auto: what is faster on this GPU "
                   "(default: $AFTERSHADE_DRAW_WITH, else auto)")
        ->check(CLI::IsMember({"auto", "fragment", "compute"}));
    app.add_option("--read-ahead", options.read_ahead,
                   "Frames to read, and frames to write, while one is rendered (default: a quarter of "
                   "the cores, at most 8, as far as memory has room)")
        ->check(CLI::Range(1, 64));
    add_plugin_options(app, options.plugins);
}

std::string RunArguments::stream_output() const {
    const auto found = std::ranges::find_if(outputs, is_stream);
    return found == outputs.end() ? "" : *found;
}

std::string RunArguments::needs_every_frame() const {
    return resume.overwrite          ? "--overwrite"
           : resume.no_journal       ? "--no-journal"
           : streams()               ? "-o " + stream_output()
           : audit                   ? "--audit"
           : !telemetry_plot.empty() ? "--telemetry-plot"
                                     : "";
}

bool RunArguments::changes_window() const {
    return parse_scale(scale) != 1 || !region.empty();
}

LookVariables look_variables(const RunArguments& options, Diagnostics& diagnostics) {
    LookVariables variables;
    for (const std::string& text : options.variables) {
        const Place place{"--var " + text};
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0) {
            diagnostics.error(place, "expected name=value");
            continue;
        }
        if (!variables.emplace(text.substr(0, equals), parse_command_value(text.substr(equals + 1), place))
                 .second)
            diagnostics.error(place, "this variable is given twice");
    }
    return variables;
}

OutputOptions output_options(const RunArguments& options) {
    OutputOptions outputs;
    std::ranges::remove_copy_if(options.outputs, std::back_inserter(outputs.patterns), is_stream);
    if (const std::string stream = options.stream_output(); !stream.empty()) {
        // check_stream_options refuses other names
        const auto format = find_stream_format(options.stream.format).value_or(StreamFormat::png);
        outputs.stream_format = video_stream_format(stream).value_or(format);
    }
    if (!options.roles.empty()) outputs.roles = options.roles;
    if (options.pixel_type == "float") outputs.color_type = PixelType::float32;
    outputs.keep_channels = options.keep_channels;
    outputs.crop_to_display = options.crop == "display";
    outputs.png_bits = options.png_bits;
    outputs.compression = options.compression;
    // Its folder is no part of the picture: files of a farm are those of one run, byte for byte.
    outputs.look = std::filesystem::path(options.look).filename().string();
    outputs.telemetry = options.telemetry;
    for (const std::string& tap : options.pipeline.taps) {
        const std::size_t equals = tap.find('=');
        outputs.taps.push_back(tap.substr(0, equals));
        if (equals != std::string::npos) outputs.tap_patterns[outputs.taps.back()] = tap.substr(equals + 1);
    }
    return outputs;
}

RunOptions run_options(const RunArguments& options, Diagnostics& diagnostics) {
    RunOptions run;
    run.scale_divisor = parse_scale(options.scale);
    if (run.scale_divisor == 0) {
        diagnostics.error({"--scale " + options.scale}, "must be 1, 1/2, 1/3 ... or 1/64");
        run.scale_divisor = 1;
    }
    run.region_margin_px = options.region_margin_px;
    if (!options.region.empty()) {
        run.region = parse_region(options.region);
        if (!run.region)
            diagnostics.error({"--region " + options.region},
                              "must be x,y,w,h in px from the display window's top left, w and h at least 1");
    }
    run.history_in = options.history_in;
    run.history_out = options.history_out;
    if (!options.graph.empty() && !options.graph.ends_with(".dot") && !options.graph.ends_with(".svg"))
        diagnostics.error({"--graph " + options.graph}, "must end in .dot or .svg");
    if (options.keep_channels && options.changes_window())
        diagnostics.error({"--keep-channels"},
                          "keeps the source's channels, which --scale and --region change");
    if (!options.telemetry_plot.empty() && !options.telemetry_plot.ends_with(".svg"))
        diagnostics.error({"--telemetry-plot " + options.telemetry_plot}, "must end in .svg");
    if (!options.trace.empty() && !options.trace.ends_with(".json"))
        diagnostics.error({"--trace " + options.trace}, "must end in .json");
    run.missing = missing_frame(options.missing);
    run.on_nan = nan_policy(options.on_nan);
    run.frames_ahead = options.read_ahead;
    run.drawing.audits = options.audit;
    run.drawing.fuses_passes = !options.apart && !options.plain;
    run.drawing.plain = options.plain;
    run.drawing.draw_with = parse_draw_with(options.draw_with).value_or(DrawWith::automatic);
    // A gap in a stream would shift every frame behind it.
    run.stop_on_error = options.jobs.stop_on_error || options.streams();
    run.drawing.telemetry = !options.telemetry.empty() || !options.telemetry_plot.empty();
    return run;
}

}  // namespace aftershade::cli
