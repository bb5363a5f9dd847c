#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/capture_options.h"
#include "cli/effect_options.h"
#include "cli/gl_options.h"
#include "cli/plugin_options.h"
#include "cli/verbs.h"
#include "framework/base/cores.h"
#include "framework/base/data_path.h"
#include "framework/base/error.h"
#include "framework/base/scratch_folder.h"
#include "framework/base/status.h"
#include "framework/effect/program_store.h"
#include "framework/gpu/driver_cache.h"
#include "framework/look/look.h"
#include "framework/run/run_frames.h"

namespace aftershade::cli {

namespace {

struct WarmOptions {
    std::string look;
    CaptureOptions capture;
    std::vector<std::string> effect_paths;
    PluginOptions plugins;
    GlOptions gl;
};

/// Seconds to render the frames in a context of its own, to files with these extensions, written where nobody
/// looks.
double render_s(const gpu::GlChoice& gl, const Pipeline& pipeline, const Sequence& sequence,
                const CaptureReader& reader, const RunOptions& run,
                const std::vector<std::string>& extensions) {
    const ScratchFolder scratch;
    OutputOptions outputs;
    for (const std::string& extension : extensions)
        outputs.patterns.push_back((scratch.path() / ("frame_####" + extension)).string());
    const std::atomic<bool> stop = false;
    const auto begin = std::chrono::steady_clock::now();
    gpu::Context context(gl);
    const RunReport report = run_frames(
        {[&]() -> gpu::Context& { return context; }, pipeline, sequence, reader, run, outputs, data_path()},
        {}, stop);
    if (!report.failures.empty()) throw Error(ErrorKind::capture, report.failures.front().message);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

ExitCode warm(const WarmOptions& options) {
    Diagnostics diagnostics;
    const gpu::GlChoice gl = chosen_gl(options.gl);
    EffectRegistry effects = find_effects(options.effect_paths, diagnostics);
    const auto look = read_look(options.look, diagnostics);
    const Pipeline pipeline = look ? bind_pipeline(*look, effects, {}, diagnostics) : Pipeline{};
    std::vector<Profile> profiles = load_profiles(options.capture.profile_paths, diagnostics);
    const auto sequence = find_sequence(options.capture, profiles, diagnostics);
    const ProgramStore store = ProgramStore::from_environment();
    if (!store.is_on())
        diagnostics.error({"AFTERSHADE_CACHE"},
                          "the cache is off; set the variable to a folder, or leave it unset");
    stop_at_errors(diagnostics);
    diagnostics.print(std::cerr);
    for (const std::string& fault : {store.fault(), gpu::prepare_driver_cache()})
        if (!fault.empty()) throw Error(ErrorKind::output, "nothing can be cached: " + fault);
    if (const auto code = run_in_worker(options.plugins, pipeline.has_foreign())) return *code;

    const CaptureReader reader(*sequence, std::move(profiles), options.capture.limits);
    StatusWriter status;
    NativeRegistry natives = native_registry(options.plugins, &status);
    RunOptions run;
    // The second frame reads a history, and sets back what the first one drew in tiles.
    constexpr std::size_t kFrames = 2;
    run.frames.assign(sequence->frames.begin(),
                      sequence->frames.begin() + std::ptrdiff_t(std::min(kFrames, sequence->frames.size())));
    run.natives = {&natives, &status};
    run.drawing.compile_threads = allotted_cores() - 1;
    // What a file takes decides which textures the last pass writes, and so its program.
    double first_s = 0;
    for (const auto& extensions : std::vector<std::vector<std::string>>{{".exr"}, {".png"}, {".exr", ".png"}})
        first_s += render_s(gl, pipeline, *sequence, reader, run, extensions);
    const double then_s = render_s(gl, pipeline, *sequence, reader, run, {".exr"});
    fmt::print("{}: {:.2f} s at first, {:.2f} s from now on\nprograms are in {}\n", options.look, first_s,
               then_s, store.folder().string());
    return ExitCode::done;
}

}  // namespace

Verb add_warm(CLI::App& app) {
    auto options = std::make_shared<WarmOptions>();
    app.add_option("look", options->look, "The look")->type_name("LOOK")->required();
    add_capture_argument(app, options->capture);
    add_capture_options(app, options->capture,
                        "The frame whose roles and size decide the programs (default: the first)");
    add_effect_path_option(app, options->effect_paths);
    add_ocio_option(app);
    add_plugin_options(app, options->plugins);
    add_gl_options(app, options->gl);
    return [options] { return warm(*options); };
}

}  // namespace aftershade::cli
