#include "framework/effect/describe.h"

#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>

#include "cli/capture_options.h"
#include "cli/effect_options.h"
#include "cli/verbs.h"

namespace aftershade::cli {

namespace {

struct DescribeOptions {
    std::string effect;
    std::vector<std::string> effect_paths;
    bool json = false;
};

ExitCode describe(const DescribeOptions& options) {
    Diagnostics diagnostics;
    EffectRegistry effects = find_effects(options.effect_paths, diagnostics);
    if (!effects.contains(options.effect)) {
        const auto ids = effects.ids();
        diagnostics.error({"EFFECT"},
                          "no effect '" + options.effect + "'" + did_you_mean(options.effect, ids));
    }
    const EffectManifest* manifest = effects.find(options.effect, diagnostics);
    stop_at_errors(diagnostics);
    fmt::print("{}{}", options.json ? describe_json(*manifest) : describe_text(*manifest),
               options.json ? "\n" : "");
    return ExitCode::done;
}

}  // namespace

Verb add_describe(CLI::App& app) {
    auto options = std::make_shared<DescribeOptions>();
    app.add_option("effect", options->effect, "Id of an effect")->required();
    add_effect_path_option(app, options->effect_paths);
    app.add_flag("--json", options->json, "Machine-readable output");
    return [options] { return describe(*options); };
}

}  // namespace aftershade::cli
