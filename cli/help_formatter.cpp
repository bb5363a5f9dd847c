#include "cli/help_formatter.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

#include "cli/command_tree.h"
#include "framework/base/text.h"

namespace aftershade::cli {

namespace {

constexpr std::size_t kColumns = 100, kTextColumn = 27;

/// Lines of words, each at most `width` columns unless one word is longer.
std::vector<std::string> wrapped(std::string_view text, std::size_t width) {
    std::vector<std::string> lines{""};
    for (const std::string_view word : split(text, ' ')) {
        std::string& line = lines.back();
        if (line.empty()) line = word;
        else if (line.size() + 1 + word.size() <= width) (line += ' ') += word;
        else lines.emplace_back(word);
    }
    return lines;
}

std::string row(const std::string& head, const std::string& text) {
    std::string out = "  " + head;
    bool is_first = out.size() + 2 <= kTextColumn;
    if (!is_first) out += "\n";
    for (const std::string& line : wrapped(text, kColumns - kTextColumn)) {
        out += std::string(is_first ? kTextColumn - out.size() : kTextColumn, ' ') + line + "\n";
        is_first = false;
    }
    return out;
}

/// Whether the description has all choices already.
bool names_choices(const CommandOption& option) {
    return std::ranges::all_of(option.choices, [&](const std::string& choice) {
        return option.description.find(choice) != std::string::npos;
    });
}

/// "1 to 10; default: 2"; "" where there is nothing to add.
std::string notes(const CommandOption& option) {
    std::vector<std::string> parts;
    if (!names_choices(option)) parts.push_back(joined(option.choices, " or "));
    if (!option.limits.empty()) parts.push_back(option.limits);
    if (!option.default_value.empty()) parts.push_back("default: " + option.default_value);
    if (option.required && !option.positional) parts.emplace_back("required");
    for (const std::string& other : option.needs) parts.push_back("needs " + other);
    for (const std::string& other : option.excludes) parts.push_back("not with " + other);
    return joined(parts, "; ", "; ");
}

/// The description with its notes in parentheses; behind a default that it gives itself, in the same ones.
std::string described(const CommandOption& option) {
    const std::string& text = option.description;
    const std::string more = notes(option);
    if (more.empty()) return text;
    const std::size_t open = text.rfind(" (default: ");
    if (text.ends_with(')') && open != std::string::npos)
        return text.substr(0, text.size() - 1) + "; " + more + ")";
    return text + " (" + more + ")";
}

void add_rows(const std::vector<CommandOption>& options, const std::string& title, bool positionals,
              const std::string& group, std::string& out) {
    std::string rows;
    for (const CommandOption& option : options) {
        if (option.positional != positionals || option.group != group) continue;
        std::string head = joined(option.names, ", ");
        if (!positionals && option.takes_value()) head += " " + option.type;
        rows += row(head, described(option));
    }
    if (!rows.empty()) out += "\n" + title + ":\n" + rows;
}

/// "aftershade compare [OPTIONS] reference test".
std::string usage(const Command& command, const std::string& name) {
    std::string line = "Usage: " + name + " [OPTIONS]";
    for (const CommandOption& option : command.options) {
        if (!option.positional) continue;
        const std::string word = option.names.front() + (option.repeatable ? "..." : "");
        line += option.required ? " " + word : " [" + word + "]";
    }
    return line + (command.subcommands.empty() ? "" : " SUBCOMMAND");
}

/// The headings of options in their order, without that of the others, which is "".
std::vector<std::string> groups(const Command& command) {
    std::vector<std::string> names;
    for (const CommandOption& option : command.options)
        if (!option.group.empty() && std::ranges::find(names, option.group) == names.end())
            names.push_back(option.group);
    return names;
}

}  // namespace

std::string HelpFormatter::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode) const {
    const Command command = command_tree(*app);
    std::string out = command.description + "\n\n" + usage(command, name) + "\n";
    add_rows(command.options, "Positionals", true, "", out);
    add_rows(command.options, "Options", false, "", out);
    for (const std::string& group : groups(command)) add_rows(command.options, group, false, group, out);
    if (!command.subcommands.empty()) out += "\nSubcommands:\n";
    for (const Command& below : command.subcommands) out += row(below.path.back(), below.description);
    if (!command.footer.empty()) out += "\n";
    for (const std::string_view paragraph : split(command.footer, '\n'))
        for (const std::string& line : wrapped(paragraph, kColumns)) out += line + "\n";
    return out;
}

}  // namespace aftershade::cli
