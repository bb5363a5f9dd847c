#include "framework/effect/description.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <memory>

#include "cli/capture_options.h"
#include "cli/command_tree.h"
#include "cli/effect_options.h"
#include "cli/ocio_names.h"
#include "cli/profile_report.h"
#include "cli/verbs.h"
#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/scattering/param_scattering.h"

namespace aftershade::cli {

namespace {

struct DescribeOptions {
    std::string what;
    std::vector<std::string> effect_paths;
    bool json = false, verbose = false;
    std::string plot;
};

/// The default of the effect's first scattering_profile parameter.
ScatteringProfile profile_of(const EffectManifest& manifest, Diagnostics& diagnostics) {
    for (const ParamSpec& spec : manifest.params)
        if (const auto* value = scattering_of(spec.default_value)) return value->usual;
    diagnostics.error({"--plot"}, "the effect '" + manifest.id + "' has no scattering_profile to plot");
    stop_at_errors(diagnostics);
    return {};
}

void write_plot(const ScatteringProfile& profile, const std::string& path) {
    write_text_file(path, profile_plot(profile));
    fmt::print("{}\n", path);
}

ExitCode describe(const DescribeOptions& options) {
    Diagnostics diagnostics;
    EffectRegistry effects = find_effects(options.effect_paths, diagnostics);
    if (!effects.contains(options.what)) {
        if (const auto profile = find_profile(options.what, diagnostics)) {
            if (!options.plot.empty()) write_plot(*profile, options.plot);
            else
                fmt::print("{}{}", options.json ? profile_json(*profile) : profile_text(*profile),
                           options.json ? "\n" : "");
            return ExitCode::done;
        }
        stop_at_errors(diagnostics);
        auto known = effects.ids();
        const auto shipped = scattering_profile_names();
        known.insert(known.end(), shipped.begin(), shipped.end());
        diagnostics.error({"WHAT"}, "no effect or scattering profile '" + options.what + "'" +
                                        did_you_mean(options.what, known) +
                                        "; a profile's file ends in .json");
    }
    const EffectManifest* manifest = effects.find(options.what, diagnostics);
    stop_at_errors(diagnostics);
    if (!options.plot.empty()) {
        write_plot(profile_of(*manifest, diagnostics), options.plot);
        return ExitCode::done;
    }
    const auto names = ocio_names(*manifest, diagnostics);
    diagnostics.print(std::cerr);
    if (options.json) fmt::print("{}\n", with_ocio_names(describe_json(*manifest), names));
    else
        fmt::print("{}{}", printable_lines(describe_text(*manifest, options.verbose)),
                   ocio_names_text(names));
    return ExitCode::done;
}

}  // namespace

Verb add_describe(CLI::App& app) {
    auto options = std::make_shared<DescribeOptions>();
    app.add_option("what", options->what,
                   "An effect's id, a scattering profile's name, or the path of its .json")
        ->type_name(kEffectId)
        ->required();
    add_effect_path_option(app, options->effect_paths);
    add_ocio_option(app);
    auto* json = app.add_flag("--json", options->json, "Print JSON");
    app.add_flag("-v,--verbose", options->verbose,
                 "Also print an effect's sources, textures, telemetry and passes");
    app.add_option("--plot", options->plot,
                   "Plot the scattering profile, or an effect's default one, to this .svg")
        ->type_name("FILE")
        ->excludes(json);
    return [options] { return describe(*options); };
}

}  // namespace aftershade::cli
