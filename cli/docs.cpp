#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/capture_options.h"
#include "cli/command_tree.h"
#include "cli/documents.h"
#include "cli/effect_options.h"
#include "cli/verbs.h"
#include "framework/base/atomic_file.h"
#include "framework/base/side_file.h"
#include "framework/base/text.h"
#include "framework/effect/description.h"
#include "framework/scene/scene_schema.h"

namespace aftershade::cli {

namespace {

namespace fs = std::filesystem;

// Manual pages in man(7), made from the declarations of the command line.

/// Text that man prints as it is: hyphens stay what a shell takes, and no line is taken for a request
/// (groff_char(7)).
std::string roff(std::string_view text) {
    std::string result;
    for (const char c : text)
        if (c == '\\') result += "\\(rs";
        else if (c == '-') result += "\\-";
        else if (c == '^') result += "\\(ha";
        else if (c == '~') result += "\\(ti";
        else if (c == '`') result += "\\(ga";
        else if (c == '\'') result += "\\(aq";
        else result += c;
    if (result.starts_with('.')) result.insert(0, "\\&");
    return result;
}

std::string bold(std::string_view text) {
    return "\\fB" + roff(text) + "\\fR";
}
std::string italic(std::string_view text) {
    return "\\fI" + roff(text) + "\\fR";
}

std::string value_text(const CommandOption& option) {
    if (option.choices.empty()) return italic(option.type);
    std::string words;
    for (const std::string& choice : option.choices) words += (words.empty() ? "" : "|") + bold(choice);
    return words;
}

std::string heading_of(const CommandOption& option) {
    if (option.positional) return italic(option.names.front());
    std::string names;
    for (const std::string& name : option.names) names += (names.empty() ? "" : ", ") + bold(name);
    return option.takes_value() ? names + " " + value_text(option) : names;
}

std::string entry(const CommandOption& option) {
    std::string text = ".TP\n" + heading_of(option) + "\n" + roff(option.description);
    std::string more;
    if (!option.limits.empty()) more += roff(option.limits);
    if (!option.default_value.empty())
        more += (more.empty() ? "" : "; ") + ("default: " + roff(option.default_value));
    if (option.required && !option.positional) more += more.empty() ? "required" : "; required";
    return text + (more.empty() ? "\n" : " (" + more + ")\n");
}

std::string synopsis(const Command& command) {
    std::string text = ".SH SYNOPSIS\n" + bold(command_name(command)) + " [" + italic("options") + "]";
    if (!command.subcommands.empty()) return text + " " + italic("command") + " ...\n";
    for (const CommandOption& option : command.options)
        if (option.positional) {
            const std::string word = italic(option.names.front()) + (option.repeatable ? " ..." : "");
            text += option.required ? " " + word : " [" + word + "]";
        }
    return text + "\n";
}

/// Options under the headings that `--help` has, in its order.
std::string options_text(const Command& command) {
    std::string text, group;
    for (const bool positional : {true, false}) {
        bool first = true;
        for (const CommandOption& option : command.options) {
            if (option.positional != positional) continue;
            if (first) text += positional ? ".SH ARGUMENTS\n" : ".SH OPTIONS\n";
            first = false;
            if (option.group != group && !option.group.empty()) text += ".SS " + roff(option.group) + "\n";
            group = option.group;
            text += entry(option);
        }
    }
    return text;
}

std::string see_also(const Command& command, const Command& root) {
    std::string text;
    const auto add = [&](const Command& other) {
        if (&other == &command) return;
        text += (text.empty() ? ".SH SEE ALSO\n" : ",\n") + bold(command_name(other, "-")) + "(1)";
    };
    if (!command.path.empty()) add(root);
    for (const Command& subcommand : command.subcommands) add(subcommand);
    return text.empty() ? text : text + "\n";
}

std::string page(const Command& command, const Command& root, const std::string& version) {
    const std::string name = command_name(command, "-");
    std::string text = ".TH \"" + roff(name) + "\" 1 \"\" \"aftershade " + roff(version) + "\"\n";
    text += ".SH NAME\n" + roff(name) + " \\- " + roff(command.description) + "\n" + synopsis(command);
    if (!command.subcommands.empty()) text += ".SH COMMANDS\n";
    for (const Command& subcommand : command.subcommands)
        text += ".TP\n" + bold(subcommand.path.back()) + "\n" + roff(subcommand.description) + "\n";
    text += options_text(command);
    if (!command.footer.empty()) text += ".SH EXIT STATUS\n" + roff(command.footer) + "\n";
    return text + see_also(command, root);
}

/// Page of section 1 for each command by its file name: "aftershade.1", "aftershade-golden-run.1". Long lines
/// of options' descriptions are left to man, which fills them.
std::map<std::string, std::string> man_pages(const Command& root, const std::string& version) {
    std::map<std::string, std::string> pages;
    for (const Command* command : all_commands(root))
        pages[command_name(*command, "-") + ".1"] = page(*command, root, version);
    return pages;
}

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
