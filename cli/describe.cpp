#include <algorithm>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/capture_options.h"
#include "cli/command_tree.h"
#include "cli/effect_options.h"
#include "cli/profile_report.h"
#include "cli/verbs.h"
#include "framework/base/atomic_file.h"
#include "framework/base/diagnostics.h"
#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/color/color_transform.h"
#include "framework/effect/description.h"
#include "framework/effect/manifest/manifest.h"
#include "framework/scattering/param_scattering.h"

namespace aftershade::cli {

namespace {

// What the user's OpenColorIO config has for the parameters of an effect that takes one.

/// nullopt for effects without such a parameter, and where the config cannot be read, of which it warns.
std::optional<ColorNames> ocio_names(const EffectManifest& manifest, Diagnostics& diagnostics) {
    const auto takes_config = [](const ParamSpec& spec) {
        return is_ocio_file(spec) && spec.file_kind == FileKind::ocio_config;
    };
    if (std::ranges::none_of(manifest.params, takes_config)) return std::nullopt;
    auto read = color_names("");
    if (auto* names = std::get_if<ColorNames>(&read)) return std::move(*names);
    diagnostics.warning({"OpenColorIO"}, std::get<ColorFault>(read).text);
    return std::nullopt;
}

/// "" without names.
std::string ocio_names_text(const std::optional<ColorNames>& names) {
    if (!names) return "";
    std::string text = "\nNames in " + names->config + " (--ocio names another config):\n";
    for (const auto& [display, views] : names->views)
        text += "  display '" + display + "' has the views " + list_of_names(views, "and") + "\n";
    if (!names->looks.empty()) text += "  looks: " + list_of_names(names->looks, "and") + "\n";
    text += "  spaces: " + list_of_names(names->spaces, "and") + "\n";
    for (const auto& [role, space] : names->roles) text += "  role " + role + " is '" + space + "'\n";
    return printable_lines(text);
}

/// The description with a member "ocio".
std::string with_ocio_names(const std::string& description, const std::optional<ColorNames>& names) {
    if (!names) return description;
    auto json = nlohmann::ordered_json::parse(description);
    auto& member = json["ocio"];
    member["config"] = names->config;
    for (const auto& [display, views] : names->views) member["displays"][display] = views;
    member["looks"] = names->looks;
    member["spaces"] = names->spaces;
    for (const auto& [role, space] : names->roles) member["roles"][role] = space;
    return json.dump(2);
}

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
