// The words of `aftershade run`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/capture_options.h"
#include "cli/cli11.h"
#include "cli/gl_options.h"
#include "cli/job_options.h"
#include "cli/plugin_options.h"
#include "cli/resume.h"
#include "cli/stream_options.h"
#include "framework/base/diagnostics.h"
#include "framework/look/look.h"
#include "framework/look/pipeline.h"
#include "framework/run/run_options.h"

namespace aftershade::cli {

struct RunArguments {
    std::string look;
    std::string look_folder;
    std::vector<std::string> outputs;
    std::vector<std::string> roles;
    std::vector<std::string> effect_paths;
    std::string pixel_type = "half";
    int png_bits = 0;
    GlOptions gl;
    std::string draw_with;
    int read_ahead = 0;
    std::string progress = "auto";
    std::string missing = "error";
    std::string on_nan = "warn";
    std::string crop = "data";
    std::string compression = "zip";
    bool keep_channels = false;
    bool audit = false;
    bool apart = false;
    bool plain = false;
    bool explain = false, verbose = false;
    bool watch = false;
    std::string telemetry;
    std::string telemetry_plot;
    std::string trace;
    std::vector<std::string> variables;
    std::string scale = "1";
    std::string region;
    std::optional<int> region_margin_px;
    std::string history_in;
    std::string history_out;
    std::string graph;
    PipelineOptions pipeline;
    CaptureOptions capture;
    PluginOptions plugins;
    JobArguments jobs;
    ResumeArguments resume;
    StreamArguments stream;

    /// Whether frames go to standard output.
    bool streams() const { return !stream_output().empty(); }
    /// The output that is "-" or a video; "" where frames go into files alone.
    std::string stream_output() const;
    /// The option that makes each run render every frame, current or not; "" for none.
    std::string needs_every_frame() const;
    /// Whether outputs have other pixels than the source.
    bool changes_window() const;
};

void add_run_options(CLI::App& app, RunArguments& arguments);

/// "--var focus=2.4 m" as values above the look's "vars".
LookVariables look_variables(const RunArguments& arguments, Diagnostics& diagnostics);
/// Without the renderer, which is not known yet.
OutputOptions output_options(const RunArguments& arguments);
/// Without the frames and native code, which words alone do not give.
RunOptions run_options(const RunArguments& arguments, Diagnostics& diagnostics);

}  // namespace aftershade::cli
