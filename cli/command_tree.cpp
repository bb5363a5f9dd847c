#include "cli/command_tree.h"

#include <CLI/CLI.hpp>

#include <set>
#include <string_view>

#include "framework/base/text.h"

namespace aftershade::cli {

namespace {

/// "INT in [1 - 9]" as "1 to 9"; CLI11's words for numbers above or from 0 as themselves.
std::string limits_of(const std::string& text) {
    if (text == "POSITIVE") return "above 0";
    if (text == "NONNEGATIVE") return "at least 0";
    const std::size_t open = text.find('['), dash = text.find(" - ");
    if (open == std::string::npos || dash == std::string::npos || !text.ends_with(']')) return text;
    return text.substr(open + 1, dash - open - 1) + " to " + text.substr(dash + 3, text.size() - dash - 4);
}

/// "TEXT:{a,b}" is a type with its choices, "INT:INT in [1 - 9]" one with its limits, "UINT:SIZE" a
/// number of bytes with a unit (CLI::Option::get_type_name).
void read_type(const std::string& text, CommandOption& option) {
    const std::size_t colon = text.find(':');
    option.type = text.substr(0, colon);
    if (colon == std::string::npos) return;
    const std::string rest = text.substr(colon + 1);
    if (rest == "SIZE") {
        option.type = "SIZE";
        return;
    }
    if (!rest.starts_with('{') || !rest.ends_with('}')) {
        option.limits = limits_of(rest);
        return;
    }
    for (const std::string_view word : split(std::string_view(rest).substr(1, rest.size() - 2), ','))
        option.choices.emplace_back(word);
}

std::vector<std::string> names_of(const std::set<CLI::Option*>& options) {
    std::vector<std::string> names;
    for (const CLI::Option* option : options) names.push_back(option->get_name());
    return names;
}

CommandOption command_option(const CLI::Option& declared) {
    CommandOption option;
    option.positional = declared.get_positional();
    if (option.positional) option.names = {declared.get_name(true)};
    for (const std::string& name : declared.get_snames()) option.names.push_back("-" + name);
    for (const std::string& name : declared.get_lnames()) option.names.push_back("--" + name);
    option.description = declared.get_description();
    if (declared.get_type_size() != 0) read_type(declared.get_type_name(), option);
    option.default_value = declared.get_default_str();
    // CLI11's own heading; "OPTIONS" from 2.5 on.
    if (lower_case(declared.get_group()) != "options") option.group = declared.get_group();
    option.required = declared.get_required();
    option.repeatable = declared.get_items_expected_max() > 1;
    option.needs = names_of(declared.get_needs());
    option.excludes = names_of(declared.get_excludes());
    return option;
}

Command command(const CLI::App& app, const std::vector<std::string>& path,
                const std::string& parents_footer) {
    Command result;
    result.path = path;
    result.description = app.get_description();
    result.footer = app.get_footer().empty() ? parents_footer : app.get_footer();
    for (const bool positionals : {true, false})
        for (const CLI::Option* option : app.get_options())
            if (option->get_positional() == positionals && !option->get_group().empty())
                result.options.push_back(command_option(*option));
    for (const CLI::App* subcommand : app.get_subcommands([](const CLI::App*) { return true; })) {
        std::vector<std::string> path_below = path;
        path_below.push_back(subcommand->get_name());
        result.subcommands.push_back(command(*subcommand, path_below, result.footer));
    }
    return result;
}

void collect(const Command& command, std::vector<const Command*>& commands) {
    commands.push_back(&command);
    for (const Command& subcommand : command.subcommands) collect(subcommand, commands);
}

}  // namespace

Command command_tree(const CLI::App& app) {
    return command(app, {}, "");
}

std::vector<const Command*> all_commands(const Command& root) {
    std::vector<const Command*> commands;
    collect(root, commands);
    return commands;
}

std::string command_name(const Command& command, const std::string& separator) {
    std::string name = "aftershade";
    for (const std::string& word : command.path) name += separator + word;
    return name;
}

}  // namespace aftershade::cli
