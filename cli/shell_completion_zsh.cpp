#include "cli/shell_completion.h"

namespace aftershade::cli {

namespace {

constexpr const char* kZshBegin = R"zsh(#compdef aftershade
# Completion of aftershade for zsh, made by: aftershade completion zsh

_aftershade_effects() {
    local -a effects
    effects=(${(f)"$(aftershade list 2>/dev/null | while read -r id rest; do print -r -- $id; done)"})
    _describe effect effects
    _files
}

)zsh";

/// Inside '...', where brackets and colons end what _arguments takes for a description.
std::string zsh_text(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
        if (c == '\'') result += "'\\''";
        else result += c;
    }
    return result;
}

std::string action(const CommandOption& option) {
    if (option.takes_effect_id()) return "_aftershade_effects";
    if (option.choices.empty()) return option.is_number() ? " " : "_files";
    std::string words;
    for (const std::string& choice : option.choices) words += (words.empty() ? "" : " ") + choice;
    return "(" + words + ")";
}

std::string positional_spec(const CommandOption& option, int place) {
    const std::string where = option.repeatable ? "*" : std::to_string(place) + (option.required ? "" : ":");
    return "'" + where + ":" + zsh_text(option.names.front()) + ":" + action(option) + "'";
}

/// One row of _arguments for each name; names of one option exclude each other unless it may be repeated.
std::string option_specs(const CommandOption& option) {
    std::string all, text;
    for (const std::string& name : option.names) all += (all.empty() ? "" : " ") + name;
    for (const std::string& name : option.names) {
        const std::string joined = !option.takes_value() ? "" : name.starts_with("--") ? "=" : "+";
        text += " \\\n        '" + (option.repeatable ? "*" : "(" + all + ")") + name + joined + "[" +
                zsh_text(option.description) + "]";
        if (option.takes_value()) text += ":" + zsh_text(option.type) + ":" + action(option);
        text += "'";
    }
    return text;
}

std::string specs(const Command& command) {
    std::string text;
    int place = 0;
    for (const CommandOption& option : command.options)
        text += option.positional ? " \\\n        " + positional_spec(option, ++place) : option_specs(option);
    return text;
}

std::string function(const Command& command) {
    const std::string name = "_" + command_name(command, "_");
    if (command.subcommands.empty()) return name + "() {\n    _arguments" + specs(command) + "\n}\n\n";
    std::string text = name + "() {\n    local line state\n    _arguments -C" + specs(command) +
                       " \\\n        '1: :->command' '*:: :->arguments'\n    case $state in\n"
                       "    command)\n        local -a commands=(\n";
    for (const Command& one : command.subcommands)
        text += "            '" + one.path.back() + ":" + zsh_text(one.description) + "'\n";
    text += "        )\n        _describe command commands ;;\n    arguments)\n        case $line[1] in\n";
    for (const Command& one : command.subcommands)
        text += "        " + one.path.back() + ") _" + command_name(one, "_") + " ;;\n";
    return text + "        esac ;;\n    esac\n}\n\n";
}

}  // namespace

std::string zsh_completion(const Command& root) {
    std::string text = kZshBegin;
    for (const Command* command : all_commands(root)) text += function(*command);
    return text +
           "if [ \"$funcstack[1]\" = _aftershade ]; then _aftershade \"$@\"; "
           "else compdef _aftershade aftershade; fi\n";
}

}  // namespace aftershade::cli
