#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>

#include "cli/capture_options.h"
#include "cli/effect_options.h"
#include "cli/verbs.h"
#include "framework/base/text.h"
#include "framework/effect/new_effect.h"

namespace aftershade::cli {

namespace {

namespace fs = std::filesystem;

struct NewOptions {
    std::string id;
    std::string folder = ".";
};

ExitCode make(const NewOptions& options) {
    Diagnostics diagnostics;
    const EffectRegistry shipped = find_effects({}, diagnostics);
    const fs::path folder = fs::path(options.folder) / options.id;
    std::error_code failure;
    if (const fs::path path = options.id; path.has_parent_path() && is_snake_case(path.filename().string()))
        diagnostics.error({"ID"}, "'" + options.id +
                                      "' is a path; the folder has an option of its own: aftershade new " +
                                      path.filename().string() + " --path " +
                                      printed_command({path.parent_path().string()}));
    else if (!is_snake_case(options.id))
        diagnostics.error({"ID"}, "'" + options.id + "' " + kMustBeSnakeCase);
    else if (shipped.contains(options.id))
        diagnostics.error({"ID"}, "an effect that comes with Aftershade is called '" + options.id + "'");
    else if (fs::exists(folder, failure)) diagnostics.error({"ID"}, folder.string() + " is there already");
    stop_at_errors(diagnostics);
    for (const auto& [file, lines] : make_effect(options.folder, options.id))
        fmt::print("{}: {} lines\n", file.string(), lines);
    fmt::print("Run it:   aftershade run {} CAPTURE --effect-path {} -o out.png\n",
               printed_command({(folder / "look.json").string()}), printed_command({options.folder}));
    fmt::print("Check it: aftershade check {}\n", printed_command({folder.string()}));
    return ExitCode::done;
}

}  // namespace

Verb add_new(CLI::App& app) {
    auto options = std::make_shared<NewOptions>();
    app.add_option("id", options->id, "The effect's id and the name of its folder, in snake_case")
        ->required();
    app.add_option("--path", options->folder, "Create the folder here")->capture_default_str();
    return [options] { return make(*options); };
}

}  // namespace aftershade::cli
