#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/capture_options.h"
#include "cli/effect_options.h"
#include "cli/profile_report.h"
#include "cli/verbs.h"
#include "framework/effect/description.h"

namespace aftershade::cli {

namespace {

struct ListOptions {
    std::vector<std::string> effect_paths;
    bool profiles = false;
    bool json = false;
};

ExitCode list_profiles(bool as_json) {
    Diagnostics diagnostics;
    nlohmann::ordered_json document = nlohmann::ordered_json::array();
    for (const std::string& name : scattering_profile_names()) {
        const auto profile = find_profile(name, diagnostics);
        if (!profile) continue;
        const std::string& type = scattering_type_names()[std::size_t(profile->type)];
        if (!as_json) fmt::print("{:<22} {:<10} {}\n", name, type, profile->summary);
        document.push_back({{"name", name}, {"type", type}, {"summary", profile->summary}});
    }
    if (as_json) fmt::print("{}\n", document.dump(2));
    diagnostics.print(std::cerr);
    return diagnostics.has_errors() ? ExitCode::usage : ExitCode::done;
}

ExitCode list(const ListOptions& options) {
    if (options.profiles) return list_profiles(options.json);
    Diagnostics diagnostics;
    EffectRegistry effects = find_effects(options.effect_paths, diagnostics);
    stop_at_errors(diagnostics);
    std::vector<const EffectManifest*> manifests;
    for (const std::string& id : effects.ids()) {
        const int errors_before = diagnostics.error_count();
        const EffectManifest* manifest = effects.find(id, diagnostics);
        if (manifest && diagnostics.error_count() == errors_before) manifests.push_back(manifest);
    }
    nlohmann::ordered_json document = nlohmann::ordered_json::array();
    for (const EffectManifest* effect : in_groups(manifests)) {
        const std::string group = effect->group + (effect->is_recommended ? ", recommended" : "");
        if (!options.json)
            fmt::print("{:<22} {:<8} {:<24} {}\n", effect->id, effect->version, group, effect->summary);
        document.push_back({{"id", effect->id},
                            {"version", effect->version},
                            {"group", effect->group},
                            {"recommended", effect->is_recommended},
                            {"summary", effect->summary},
                            {"folder", effect->folder.string()}});
    }
    if (options.json) fmt::print("{}\n", document.dump(2));
    diagnostics.print(std::cerr);
    return diagnostics.has_errors() ? ExitCode::usage : ExitCode::done;
}

}  // namespace

Verb add_list(CLI::App& app) {
    auto options = std::make_shared<ListOptions>();
    add_effect_path_option(app, options->effect_paths);
    app.add_flag("--scattering-profiles", options->profiles, "List the shipped scattering profiles instead");
    app.add_flag("--json", options->json, "Print JSON");
    return [options] { return list(*options); };
}

}  // namespace aftershade::cli
