#include "cli/shell_completion.h"

namespace aftershade::cli {

namespace {

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

std::string path_of(const Command& command) {
    const std::string name = command_name(command);
    return command.path.empty() ? "" : name.substr(name.find(' ') + 1);
}

std::string words_of(const CommandOption& option) {
    std::string words;
    for (const std::string& choice : option.choices) words += (words.empty() ? "" : " ") + choice;
    return words;
}

std::string option_line(const CommandOption& option) {
    std::string line;
    for (const std::string& name : option.names)
        line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (option.takes_value())
        line += !option.choices.empty() ? " -x -a " + fish_text(words_of(option))
                : option.is_number()    ? " -x"
                                        : " -r -F";
    return line + " -d " + fish_text(option.description);
}

std::string argument_line(const CommandOption& option) {
    if (option.takes_effect_id())
        return " -F -a '(aftershade list 2>/dev/null | string replace -r \" .*\" \"\")'";
    return option.choices.empty() ? " -F" : " -a " + fish_text(words_of(option));
}

}  // namespace

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

}  // namespace aftershade::cli
