#include "cli/man_page.h"

#include <string_view>

#include "framework/base/text.h"

namespace aftershade::cli {

namespace {

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

}  // namespace

std::map<std::string, std::string> man_pages(const Command& root, const std::string& version) {
    std::map<std::string, std::string> pages;
    for (const Command* command : all_commands(root))
        pages[command_name(*command, "-") + ".1"] = page(*command, root, version);
    return pages;
}

}  // namespace aftershade::cli
