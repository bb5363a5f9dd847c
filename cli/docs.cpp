#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <set>

#include "cli/capture_options.h"
#include "cli/documents.h"
#include "cli/effect_options.h"
#include "cli/man_page.h"
#include "cli/verbs.h"
#include "framework/base/atomic_file.h"
#include "framework/base/side_file.h"
#include "framework/effect/description.h"
#include "framework/scene/scene_schema.h"

namespace aftershade::cli {

namespace {

namespace fs = std::filesystem;

struct DocsOptions {
    std::vector<std::string> effects;
    std::vector<std::string> effect_paths;
    std::string folder = "docs/effects";
    std::string man_folder;
    bool check = false;
};

/// A page that shows a table of a document leaves none of its others to nobody.
void check_that_all_are_shown(const grammar::Tables& tables, const std::map<std::string, std::string>& pages,
                              const fs::path& folder, Diagnostics& diagnostics) {
    std::set<std::string> shown, documents;
    for (const auto& [table, text] : tables)
        for (const auto& [name, page] : pages)
            if (grammar::shows_table(page, table)) {
                shown.insert(table);
                documents.insert(table.substr(0, table.find('.')));
            }
    for (const auto& [table, text] : tables)
        if (documents.contains(table.substr(0, table.find('.'))) && !shown.contains(table))
            diagnostics.error({folder.string()}, "no page shows the table '" + table + "'");
}

/// Pages beside the folder of the effects' pages, with the tables that stand in their marked regions.
void add_pages_with_tables(const fs::path& folder, std::map<std::string, std::string>& pages,
                           Diagnostics& diagnostics) {
    const grammar::Tables tables = document_tables();
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator((folder / "..").lexically_normal(), failure)) {
        const std::string name = "../" + entry.path().filename().string();
        if (entry.path().extension() != ".md" || pages.contains(name)) continue;
        std::vector<std::string> faults;
        pages[name] = grammar::with_tables(read_text_file(entry.path(), ErrorKind::usage), tables, faults);
        for (const std::string& fault : faults) diagnostics.error({entry.path().string()}, fault);
    }
    check_that_all_are_shown(tables, pages, folder, diagnostics);
}

/// File name, from the folder of the effects' pages, and text of every page.
std::map<std::string, std::string> pages(const DocsOptions& options, EffectRegistry& effects,
                                         Diagnostics& diagnostics) {
    std::map<std::string, std::string> pages;
    const std::vector<std::string> known = effects.ids();
    std::vector<const EffectManifest*> manifests;
    for (const std::string& id : options.effects.empty() ? known : options.effects) {
        if (!effects.contains(id))
            diagnostics.error({"EFFECT"}, "no effect '" + id + "'" + did_you_mean(id, known));
        const EffectManifest* manifest = effects.find(id, diagnostics);
        if (!manifest) continue;
        manifests.push_back(manifest);
        pages[id + ".md"] = describe_markdown(*manifest);
    }
    if (options.effects.empty()) {
        pages["README.md"] = index_markdown(manifests);
        pages["../scene-reference.md"] = scene::scene_reference();
        add_pages_with_tables(options.folder, pages, diagnostics);
    }
    return pages;
}

ExitCode docs(const DocsOptions& options) {
    Diagnostics diagnostics;
    EffectRegistry effects = find_effects(options.effect_paths, diagnostics);
    const auto made = pages(options, effects, diagnostics);
    stop_at_errors(diagnostics);
    diagnostics.print(std::cerr);
    std::error_code failure;
    if (!options.check) fs::create_directories(options.folder, failure);
    bool same = true;
    for (const auto& [name, text] : made) {
        const fs::path file = (fs::path(options.folder) / name).lexically_normal();
        if (fs::exists(file, failure) && read_text_file(file, ErrorKind::usage) == text) continue;
        same = false;
        if (!options.check) write_text_file(path_below(file.parent_path(), file.filename()), text);
        fmt::print("{}{}\n", file.string(),
                   options.check ? ": differs from the declarations; run aftershade docs" : "");
    }
    // A page of an effect that is gone.
    if (options.effects.empty() && fs::is_directory(options.folder, failure))
        for (const auto& entry : fs::directory_iterator(options.folder))
            if (entry.path().extension() == ".md" && !made.contains(entry.path().filename().string())) {
                same = false;
                fmt::print("{}: no effect has this page; delete it\n", entry.path().string());
            }
    return options.check && !same ? ExitCode::partial : ExitCode::done;
}

ExitCode write_man_pages(const CLI::App& program, const fs::path& folder) {
    for (const auto& [name, text] : man_pages(command_tree(program), AFTERSHADE_VERSION)) {
        prepare_output_folder(path_below(folder, name));
        write_text_file(path_below(folder, name), text);
        fmt::print("{}\n", (folder / name).string());
    }
    return ExitCode::done;
}

}  // namespace

Verb add_docs(CLI::App& app) {
    auto options = std::make_shared<DocsOptions>();
    app.add_option("effects", options->effects,
                   "Ids of effects (default: all, with their index, the scene reference and the tables of "
                   "other pages)")
        ->type_name(kEffectId);
    app.add_option("-o,--output", options->folder,
                   "Folder for the effects' pages; scene-reference.md and other pages go next to it")
        ->capture_default_str();
    app.add_flag("--check", options->check, "Write nothing; exit 1 if a page is out of date");
    app.add_option("--man", options->man_folder, "Write each command's manual page to this folder instead");
    add_effect_path_option(app, options->effect_paths);
    return [options, &app] {
        if (!options->man_folder.empty()) return write_man_pages(*app.get_parent(), options->man_folder);
        return docs(*options);
    };
}

}  // namespace aftershade::cli
