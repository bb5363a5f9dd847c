#include "cli/effect_options.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "framework/base/data_path.h"
#include "framework/base/path_bounds.h"
#include "framework/color/color_request.h"

namespace aftershade::cli {

void add_allow_path_option(CLI::App& app) {
    app.add_option_function<std::vector<std::string>>(
           "--allow-path", [](const std::vector<std::string>& folders) { allow_folders(folders); },
           "Let links in effects, mesh buffers and goldens lead into this folder; repeatable")
        ->allow_extra_args(false);
}

void add_ocio_option(CLI::App& app) {
    app.add_option_function<std::string>(
        "--ocio",
        [](const std::string& config) {
            const bool is_path = !is_config_address(config);
            if (std::error_code failure; is_path && !std::filesystem::is_regular_file(config, failure))
                throw CLI::ValidationError("--ocio", "no file '" + config + "'");
            choose_config(is_path ? std::filesystem::absolute(config).string() : config);
        },
        "OpenColorIO config of steps that name none (default: $OCIO, else the built-in one)");
}

void add_effect_path_option(CLI::App& app, std::vector<std::string>& paths) {
    add_allow_path_option(app);
    app.add_option("--effect-path", paths,
                   "Search this folder for effects before the shipped ones; repeatable")
        ->allow_extra_args(false);
}

void check_effect_paths(const std::vector<std::string>& paths, Diagnostics& diagnostics) {
    for (const std::string& folder : paths)
        if (std::error_code failure; !std::filesystem::is_directory(folder, failure))
            diagnostics.error({"--effect-path " + folder}, "no such folder");
}

EffectRegistry find_effects(const std::vector<std::string>& paths, Diagnostics& diagnostics) {
    std::vector<std::filesystem::path> folders(paths.begin(), paths.end());
    check_effect_paths(paths, diagnostics);
    folders.push_back(data_path() / "effects");
    EffectRegistry effects(folders);
    effects.warn_of_unreadable(diagnostics);
    effects.warn_of_hidden(diagnostics);
    return effects;
}

}  // namespace aftershade::cli
