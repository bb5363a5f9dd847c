#include "cli/effect_options.h"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "framework/core/data_path.h"

namespace aftershade::cli {

void add_effect_path_option(CLI::App& app, std::vector<std::string>& paths) {
    app.add_option("--effect-path", paths, "Folder of effects, searched before the shipped ones; repeatable")
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
    return EffectRegistry(std::move(folders));
}

}  // namespace aftershade::cli
