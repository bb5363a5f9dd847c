#include "cli/check_warmup.h"

#include <fmt/format.h>

#include <iostream>

#include "cli/capture_options.h"
#include "cli/effect_options.h"
#include "cli/gl_options.h"
#include "framework/base/data_path.h"
#include "framework/base/scratch_folder.h"
#include "framework/base/status.h"
#include "framework/base/text.h"
#include "framework/look/look.h"
#include "framework/run/warmup.h"

namespace aftershade::cli {

namespace {

/// The least warm-up measured that leaves no more than the error; -1 where none does.
int warmup_for(const std::vector<WarmupError>& measured, double error) {
    for (const WarmupError& one : measured)
        if (one.error <= error) return one.frames;
    return -1;
}

ExitCode verdict(const LookWarmup& declared, const std::vector<WarmupError>& measured) {
    if (!declared.undeclared.empty()) {
        fmt::print("{}: no declared warm-up\n", list_of_names(declared.undeclared, "and"));
        return ExitCode::partial;
    }
    const int needed = warmup_for(measured, declared.error);
    const bool holds = needed >= 0 && needed <= declared.frames;
    fmt::print("declared: {} frames for an error of {:g}; measured: {}\n", declared.frames, declared.error,
               needed >= 0 ? fmt::format("{} {}", counted(std::size_t(needed), "frame"),
                                         needed == 1 ? "suffices" : "suffice")
                           : "the capture has too few frames to reach it");
    return holds || needed < 0 ? ExitCode::done : ExitCode::partial;
}

}  // namespace

ExitCode check_warmup(const WarmupCheck& check) {
    Diagnostics diagnostics;
    EffectRegistry effects = find_effects(check.effect_paths, diagnostics);
    const auto look = read_look(check.look, diagnostics);
    const Pipeline pipeline = look ? bind_pipeline(*look, effects, {}, diagnostics) : Pipeline{};
    CaptureOptions options;
    options.capture = check.capture;
    std::vector<Profile> profiles = load_profiles({}, diagnostics);
    const auto sequence = find_sequence(options, profiles, diagnostics);
    if (sequence && sequence->frames.size() < 2)
        diagnostics.error({"--warmup " + check.capture}, "a warm-up is measured on at least 2 frames");
    stop_at_errors(diagnostics);
    if (!pipeline.has_history()) {
        fmt::print("{}: no step has history; chunks need no warm-up\n", check.look);
        return ExitCode::done;
    }
    if (const auto code = run_in_worker(check.plugins, pipeline.has_foreign())) return *code;
    const CaptureReader reader(*sequence, std::move(profiles), options.limits);
    gpu::Context context(check.gl);
    warn_of_software(context.info());
    StatusWriter status;
    NativeRegistry natives = native_registry(check.plugins, &status);
    RunOptions run;
    run.frames = sequence->frames;
    run.natives = {&natives, &status};
    const ScratchFolder scratch;
    RunObserver observer;
    observer.frame_started = [](const Capture& capture) { print_differences(capture.header); };
    const auto measured = measure_warmup(
        {[&]() -> gpu::Context& { return context; }, pipeline, *sequence, reader, run, {}, data_path()},
        scratch.path(), observer);
    fmt::print("{:>8}  {:>9}   frame {} after this many frames, against all {} before it\n", "warm-up",
               "error", run.frames.back(), run.frames.size() - 1);
    for (const WarmupError& one : measured) fmt::print("{:>8}  {:>9.3g}\n", one.frames, one.error);
    return verdict(warmup_of(pipeline), measured);
}

}  // namespace aftershade::cli
