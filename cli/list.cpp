#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "aftershade/host.h"
#include "cli/capture_options.h"
#include "cli/effect_options.h"
#include "cli/profile_report.h"
#include "cli/verbs.h"
#include "framework/base/data_path.h"

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
    check_effect_paths(options.effect_paths, diagnostics);
    stop_at_errors(diagnostics);
    diagnostics.print(std::cerr);
    const host::Host host(
        {.data = data_path(), .effect_paths = {options.effect_paths.begin(), options.effect_paths.end()}});
    std::vector<host::Diagnostic> faults;
    nlohmann::ordered_json document = nlohmann::ordered_json::array();
    for (const host::EffectInfo& effect : host.effects(&faults)) {
        if (!options.json) fmt::print("{:<22} {:<8} {}\n", effect.id, effect.version, effect.summary);
        document.push_back({{"id", effect.id},
                            {"version", effect.version},
                            {"summary", effect.summary},
                            {"folder", effect.folder}});
    }
    if (options.json) fmt::print("{}\n", document.dump(2));
    for (const host::Diagnostic& fault : faults) std::cerr << host::to_string(fault) << "\n";
    const auto is_error = [](const host::Diagnostic& fault) {
        return fault.severity == host::Severity::error;
    };
    return std::ranges::any_of(faults, is_error) ? ExitCode::usage : ExitCode::done;
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
