// Completion scripts of shells, made from the declarations of the command line: commands, options, the words
// that options take, ids of effects where one is due, and files elsewhere. bash needs no further package;
// fish and zsh find the script in their folders of completions.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/command_tree.h"
#include "cli/verbs.h"
#include "framework/base/text.h"

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

std::string path_of(const Command& command) {
    const std::string name = command_name(command);
    return command.path.empty() ? "" : name.substr(name.find(' ') + 1);
}

/// A function with one line for each command: `line` gives what its case does, "" for no line.
template <typename Line>
std::string function(const std::string& name, const Command& root, const std::string& otherwise, Line line) {
    std::string text = name + "() {\n    case $1 in\n";
    for (const Command* command : all_commands(root))
        if (const std::string body = line(*command); !body.empty())
            text += "        '" + path_of(*command) + "') " + body + " ;;\n";
    return text + "        *) " + otherwise + " ;;\n    esac\n}\n\n";
}

std::string option_names(const Command& command) {
    std::vector<std::string> names;
    for (const CommandOption& option : command.options)
        if (!option.positional) names.insert(names.end(), option.names.begin(), option.names.end());
    return "echo '" + joined(names, " ", " ") + "'";
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
    return words.empty() ? "" : "echo '" + joined(words, " ", " ") + "'";
}

/// For each option that takes a value, its possible words; no words if it may be a file or anything else.
std::string option_values(const Command& command) {
    std::string text;
    for (const CommandOption& option : command.options) {
        if (option.positional || !option.takes_value()) continue;
        text += "\n            " + joined(option.names, "|", "|") + ") echo '" +
                joined(option.choices, " ", " ") + "' ;;";
    }
    return text.empty() ? "" : "case $2 in" + text + "\n            *) return 1 ;;\n        esac";
}

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

constexpr const char* kFishFunction = R"(
# Whether the words before the cursor name this command and no longer one.
function __aftershade_at
    set -l command
    for word in (commandline -opc)[2..-1]
        string match -q -- '-*' $word; and continue
        set -l longer (string join ' ' $command $word)
        contains -- $longer $__aftershade_commands; or break
        set command $longer
    end
    test "$command" = "$argv[1]"
end

complete -c aftershade -f
)";

std::string fish_text(const std::string& text) {
    std::string result = "'";
    for (const char c : text) {
        if (c == '\\' || c == '\'') result += '\\';
        result += c;
    }
    return result + "'";
}

std::string option_line(const CommandOption& option) {
    std::string line;
    for (const std::string& name : option.names)
        line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (option.takes_value())
        line += !option.choices.empty() ? " -x -a " + fish_text(joined(option.choices, " ", " "))
                : option.is_number()    ? " -x"
                                        : " -r -F";
    return line + " -d " + fish_text(option.description);
}

std::string argument_line(const CommandOption& option) {
    if (option.takes_effect_id())
        return " -F -a '(aftershade list 2>/dev/null | string replace -r \" .*\" \"\")'";
    return option.choices.empty() ? " -F" : " -a " + fish_text(joined(option.choices, " ", " "));
}

std::string fish_completion(const Command& root) {
    std::string names, lines;
    for (const Command* command : all_commands(root)) {
        if (!command->path.empty()) names += " " + fish_text(path_of(*command));
        const std::string begin =
            "complete -c aftershade -n " + fish_text("__aftershade_at " + fish_text(path_of(*command)));
        for (const Command& one : command->subcommands)
            lines += begin + " -a " + one.path.back() + " -d " + fish_text(one.description) + "\n";
        for (const CommandOption& option : command->options)
            lines += begin + (option.positional ? argument_line(option) : option_line(option)) + "\n";
    }
    return "# Completion of aftershade for fish, made by: aftershade completion fish\n\nset -g "
           "__aftershade_commands" +
           names + "\n" + kFishFunction + lines;
}

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
    return "(" + joined(option.choices, " ", " ") + ")";
}

std::string positional_spec(const CommandOption& option, int place) {
    const std::string where = option.repeatable ? "*" : std::to_string(place) + (option.required ? "" : ":");
    return "'" + where + ":" + zsh_text(option.names.front()) + ":" + action(option) + "'";
}

/// One row of _arguments for each name; names of one option exclude each other unless it may be repeated.
std::string option_specs(const CommandOption& option) {
    const std::string all = joined(option.names, " ", " ");
    std::string text;
    for (const std::string& name : option.names) {
        const std::string between = !option.takes_value() ? "" : name.starts_with("--") ? "=" : "+";
        text += " \\\n        '" + (option.repeatable ? "*" : "(" + all + ")") + name + between + "[" +
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

std::string zsh_completion(const Command& root) {
    std::string text = kZshBegin;
    for (const Command* command : all_commands(root)) text += function(*command);
    return text +
           "if [ \"$funcstack[1]\" = _aftershade ]; then _aftershade \"$@\"; "
           "else compdef _aftershade aftershade; fi\n";
}

}  // namespace

Verb add_completion(CLI::App& app) {
    auto shell = std::make_shared<std::string>();
    app.add_option("shell", *shell, "bash, zsh or fish")
        ->required()
        ->check(CLI::IsMember({"bash", "zsh", "fish"}));
    app.footer(
        "bash: source <(aftershade completion bash)\n"
        "zsh:  source <(aftershade completion zsh), after compinit\n"
        "fish: aftershade completion fish | source");
    return [shell, &app] {
        const Command root = command_tree(*app.get_parent());
        const std::string script = *shell == "bash"  ? bash_completion(root)
                                   : *shell == "zsh" ? zsh_completion(root)
                                                     : fish_completion(root);
        std::fwrite(script.data(), 1, script.size(), stdout);
        return ExitCode::done;
    };
}

}  // namespace aftershade::cli
