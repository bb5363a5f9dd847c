#include "cli/command_tree.h"

#include <CLI/CLI.hpp>

#include <string_view>

#include "framework/core/text.h"

namespace aftershade::cli {

namespace {

/// "TEXT:{a,b}" is a type with its choices, "INT:INT in [1 - 9]" one with its limits
/// (CLI::Option::get_type_name).
void read_type(const std::string& text, CommandOption& option) {
    const std::size_t colon = text.find(':');
    option.type = text.substr(0, colon);
    if (colon == std::string::npos) return;
    const std::string rest = text.substr(colon + 1);
    if (!rest.starts_with('{') || !rest.ends_with('}')) {
        option.limits = rest;
        return;
    }
    for (const std::string_view word : split(std::string_view(rest).substr(1, rest.size() - 2), ','))
        option.choices.emplace_back(word);
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
    if (declared.get_group() != "Options") option.group = declared.get_group();
    option.required = declared.get_required();
    option.repeatable = declared.get_items_expected_max() > 1;
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
