#include "cli/shell_completion.h"

namespace aftershade::cli {

namespace {

constexpr const char* kBashFunction =
    R"(# Completion of aftershade for bash, made by: aftershade completion bash

# The longest row of words that names a command, of the words before the cursor.
_aftershade_command() {
    local command= word
    for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
        case $word in -*) continue ;; esac
        _aftershade_is_command "${command:+$command }$word" || break
        command="${command:+$command }$word"
    done
    printf %s "$command"
}

_aftershade() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command words
    command=$(_aftershade_command)
    # bash makes words of their own of --option = value.
    if [ "$word" = = ]; then word=; elif [ "$before" = = ]; then before=${COMP_WORDS[COMP_CWORD-2]}; fi
    COMPREPLY=()
    if words=$(_aftershade_values "$command" "$before"); then
        [ -n "$words" ] || return
    elif [[ $word == -* ]]; then
        words=$(_aftershade_options "$command")
    else
        words=$(_aftershade_words "$command")
    fi
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
}

complete -o bashdefault -o default -F _aftershade aftershade
)";

std::string quoted_path(const Command& command) {
    const std::string name = command_name(command);
    return "'" + (command.path.empty() ? "" : name.substr(name.find(' ') + 1)) + "'";
}

/// A function with one line for each command: `line` gives what its case does, "" for no line.
template <typename Line>
std::string function(const std::string& name, const Command& root, const std::string& otherwise, Line line) {
    std::string text = name + "() {\n    case $1 in\n";
    for (const Command* command : all_commands(root))
        if (const std::string body = line(*command); !body.empty())
            text += "        " + quoted_path(*command) + ") " + body + " ;;\n";
    return text + "        *) " + otherwise + " ;;\n    esac\n}\n\n";
}

std::string spaced(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
    return text;
}

std::string option_names(const Command& command) {
    std::vector<std::string> names;
    for (const CommandOption& option : command.options)
        if (!option.positional) names.insert(names.end(), option.names.begin(), option.names.end());
    return "echo '" + spaced(names) + "'";
}

/// Words that stand where an argument or a subcommand does; nothing lets bash complete files.
std::string argument_words(const Command& command) {
    std::vector<std::string> words;
    for (const Command& subcommand : command.subcommands) words.push_back(subcommand.path.back());
    bool effects = false;
    for (const CommandOption& option : command.options)
        if (option.positional) {
            words.insert(words.end(), option.choices.begin(), option.choices.end());
            effects |= option.takes_effect_id();
        }
    if (effects) return "aftershade list 2>/dev/null | while read -r id rest; do echo \"$id\"; done";
    return words.empty() ? "" : "echo '" + spaced(words) + "'";
}

/// Of the options that take a value: the words that it may be, or none where it is a file or anything else.
std::string option_values(const Command& command) {
    std::string text;
    for (const CommandOption& option : command.options) {
        if (option.positional || !option.takes_value()) continue;
        std::string names;
        for (const std::string& name : option.names) names += (names.empty() ? "" : "|") + name;
        text += "\n            " + names + ") echo '" + spaced(option.choices) + "' ;;";
    }
    return text.empty() ? "" : "case $2 in" + text + "\n            *) return 1 ;;\n        esac";
}

}  // namespace

std::string bash_completion(const Command& root) {
    std::string text = kBashFunction;
    const std::size_t begin = text.find("_aftershade_command()");
    const std::size_t comment = text.rfind("# The longest", begin);
    std::string tables = function("_aftershade_is_command", root, "return 1", [](const Command& command) {
        return command.path.empty() ? "" : "return 0";
    });
    tables += function("_aftershade_options", root, ":", option_names);
    tables += function("_aftershade_words", root, ":", argument_words);
    tables += function("_aftershade_values", root, "return 1", option_values);
    return text.insert(comment, tables);
}

}  // namespace aftershade::cli
