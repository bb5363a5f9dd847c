#include "cli/help_formatter.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

#include "cli/command_tree.h"
#include "framework/core/text.h"

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

}  // namespace

std::string HelpFormatter::make_option(const CLI::Option* declared, bool is_positional) const {
    CommandOption option = command_option(*declared);
    option.positional = is_positional;
    std::string head = joined(option.names, ", ");
    if (!is_positional && option.takes_value()) head += " " + option.type;
    return row(head, described(option));
}

std::string HelpFormatter::make_group(std::string group, bool is_positional,
                                      std::vector<const CLI::Option*> options) const {
    // CLI11 puts a line between two groups already, but none before the first.
    std::string out = is_positional || group == "Options" ? "\n" : "";
    out += group + ":\n";
    for (const CLI::Option* option : options) out += make_option(option, is_positional);
    return out;
}

std::string HelpFormatter::make_subcommand(const CLI::App* subcommand) const {
    return row(subcommand->get_name(), subcommand->get_description());
}

std::string HelpFormatter::make_usage(const CLI::App* app, std::string name) const {
    return "\n" + CLI::Formatter::make_usage(app, name);
}

std::string HelpFormatter::make_footer(const CLI::App* app) const {
    const std::string footer = app->get_footer();
    std::string out;
    for (const std::string_view paragraph : split(footer, '\n'))
        for (const std::string& line : wrapped(paragraph, kColumns)) out += line + "\n";
    return footer.empty() ? "" : out;
}

}  // namespace aftershade::cli
