#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/capture_options.h"
#include "cli/command_tree.h"
#include "cli/effect_options.h"
#include "cli/gl_options.h"
#include "cli/plugin_options.h"
#include "cli/verbs.h"
#include "framework/base/data_path.h"
#include "framework/base/error.h"
#include "framework/base/scratch_folder.h"
#include "framework/base/status.h"
#include "framework/base/text.h"
#include "framework/batch/process_codes.h"
#include "framework/effect/lint.h"
#include "framework/effect/manifest/manifest_reader.h"
#include "framework/effect/usage_check.h"
#include "framework/gpu/context.h"
#include "framework/look/look.h"
#include "framework/look/pipeline.h"
#include "framework/run/effect_check.h"
#include "framework/run/warmup.h"

namespace aftershade::cli {

namespace {

namespace fs = std::filesystem;

// `aftershade check LOOK --warmup CAPTURE`.

struct WarmupCheck {
    std::string look;
    std::string capture;
    std::vector<std::string> effect_paths;
    PluginOptions plugins;
    gpu::GlChoice gl;
};

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

/// Prints what a chunk's first frame differs by after more and more warm-up, and what the look declares. Exit
/// 1 where the declared warm-up leaves more than its error.
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

struct CheckOptions {
    std::string subject;
    std::vector<std::string> effect_paths;
    PluginOptions plugins;
    GlOptions gl;
    bool no_gl = false;
    bool strict = false;
    std::string warmup;
};

/// Exit 1 is the verdict; exit 2 is for words that name nothing.
ExitCode verdict(const Diagnostics& diagnostics, const CheckOptions& options) {
    diagnostics.print(std::cerr);
    const int warnings = int(diagnostics.all().size()) - diagnostics.error_count();
    fmt::print("{}: {}, {}\n", options.subject, counted(std::size_t(diagnostics.error_count()), "error"),
               counted(std::size_t(warnings), "warning"));
    const bool sound = !diagnostics.has_errors() && (warnings == 0 || !options.strict);
    return sound ? ExitCode::done : ExitCode::partial;
}

void check_one_effect(const EffectManifest& manifest, const CheckOptions& options, Diagnostics& diagnostics) {
    const fs::path data = data_path();
    check_declared_used(manifest, data / "glsl", diagnostics);
    lint_effect(manifest, data / "glsl", diagnostics);
    if (options.no_gl) return;
    gpu::Context context(chosen_gl(options.gl));
    warn_of_software(context.info());
    StatusWriter status;
    NativeRegistry natives = native_registry(options.plugins, &status);
    check_effect(context, manifest, data, {&natives, &status}, diagnostics);
    try {
        natives.require_ends();
    } catch (const Error& error) {
        diagnostics.error({manifest.id}, error.what());
    }
}

/// In a worker where it draws what a stranger wrote. `manifest` nullptr: its document has faults.
ExitCode check_effect_apart(const EffectManifest* manifest, const CheckOptions& options,
                            Diagnostics& diagnostics) {
    if (!manifest) return verdict(diagnostics, options);
    if (!options.no_gl)
        if (const auto code = run_in_worker(options.plugins, !is_shipped(*manifest))) return *code;
    check_one_effect(*manifest, options, diagnostics);
    return verdict(diagnostics, options);
}

ExitCode check(const CheckOptions& options) {
    Diagnostics words, diagnostics;
    chosen_gl(options.gl);
    std::vector<std::string> paths = options.effect_paths;
    const fs::path subject = options.subject;
    std::error_code failure;
    const bool is_folder = fs::is_regular_file(subject / "effect.json", failure);
    EffectRegistry effects = find_effects(paths, words);
    const auto stop_at_words = [&] {
        stop_at_errors(words);
        words.print(std::cerr);
    };
    if (is_folder) {
        stop_at_words();
        const fs::path folder = fs::weakly_canonical(subject, failure);
        const auto node = read_document(folder / "effect.json", diagnostics);
        const auto manifest = node ? parse_manifest(*node, folder, diagnostics) : std::nullopt;
        return check_effect_apart(manifest ? &*manifest : nullptr, options, diagnostics);
    }
    if (effects.contains(options.subject)) {
        stop_at_words();
        return check_effect_apart(effects.find(options.subject, diagnostics), options, diagnostics);
    }
    if (!fs::is_regular_file(subject, failure)) {
        const auto ids = effects.ids();
        words.error({"EFFECT|LOOK"}, "'" + options.subject +
                                         "' is not a shipped effect, an effect's folder or a look" +
                                         did_you_mean(options.subject, ids));
    }
    stop_at_words();
    if (!options.warmup.empty())
        return check_warmup(
            {options.subject, options.warmup, options.effect_paths, options.plugins, chosen_gl(options.gl)});
    if (const auto look = read_look(subject, diagnostics)) bind_pipeline(*look, effects, {}, diagnostics);
    return verdict(diagnostics, options);
}

}  // namespace

Verb add_check(CLI::App& app) {
    auto options = std::make_shared<CheckOptions>();
    app.add_option("subject", options->subject, "An effect's id or folder, or a look")
        ->type_name(kEffectId)
        ->required();
    app.add_flag("--no-gl", options->no_gl, "Check the documents only; compile no shader, render nothing");
    app.add_option("--warmup", options->warmup,
                   "For a look: measure on this capture how many warm-up frames a chunk needs");
    app.add_flag("--strict", options->strict, "Treat warnings as faults");
    add_effect_path_option(app, options->effect_paths);
    add_ocio_option(app);
    add_plugin_options(app, options->plugins);
    add_gl_options(app, options->gl);
    return [options] { return check(*options); };
}

}  // namespace aftershade::cli
