#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>

#include "cli/capture_options.h"
#include "cli/verbs.h"
#include "framework/base/text.h"
#include "framework/effect/isf/isf_effect.h"

namespace aftershade::cli {

namespace {

namespace fs = std::filesystem;

struct ImportOptions {
    std::string file, folder, space = "display";
};

ExitCode import_effect(const ImportOptions& options) {
    Diagnostics diagnostics;
    fs::path folder = fs::path(options.folder).lexically_normal();
    if (folder.filename().empty()) folder = folder.parent_path();
    const std::string id = folder.filename().string();
    std::error_code failure;
    if (!is_snake_case(id))
        diagnostics.error({"-o " + options.folder},
                          "'" + id + "', the id of the effect, " + kMustBeSnakeCase);
    else if (fs::exists(folder, failure)) diagnostics.error({"-o " + options.folder}, "is there already");
    stop_at_errors(diagnostics);
    const IsfSpace space = options.space == "linear" ? IsfSpace::linear : IsfSpace::display;
    const std::vector<fs::path> files =
        import_isf(fs::path(options.file).lexically_normal(), folder, space, diagnostics);
    stop_at_errors(diagnostics);
    for (const fs::path& file : files) fmt::print("{}\n", file.string());
    return ExitCode::done;
}

}  // namespace

Verb add_import(CLI::App& app) {
    auto options = std::make_shared<ImportOptions>();
    app.require_subcommand(1);
    auto* isf =
        app.add_subcommand("isf", "Make the folder of an effect from an ISF file and print its files");
    isf->add_option("file", options->file, "The file, with its vertex shader and pictures beside it")
        ->type_name("FILE.fs")
        ->required();
    isf->add_option("-o,--output", options->folder, "Folder to create; its name is the effect's id")
        ->type_name("FOLDER")
        ->required();
    isf->add_option("--space", options->space,
                    "The image that the effect works on: encoded display or scene-linear color")
        ->check(CLI::IsMember({"display", "linear"}))
        ->capture_default_str();
    return [options] { return import_effect(*options); };
}

}  // namespace aftershade::cli
