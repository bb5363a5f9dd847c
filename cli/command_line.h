// The command line of this process, as a person would type it.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace aftershade::cli {

/// The words that this process was started with. Throws Error(ErrorKind::effect) without /proc.
std::vector<std::string> own_arguments();

/// An option and its value, such as {"--frames", "5-10"}; with "" the option goes.
struct OptionValue {
    std::string name;
    std::string value;
};

/// `words` with these options in place of those that were there; they come right after the verb, words[1].
std::vector<std::string> with_options(const std::vector<std::string>& words,
                                      const std::vector<OptionValue>& options);

/// The variables of the environment that the program reads, as this process was started with them.
std::map<std::string, std::string> own_variables();

/// The command that repeats the task of this process, with these options in place of its own. It works in any
/// shell, with any folder and variables.
std::string command_to_repeat(const std::vector<OptionValue>& options = {});

}  // namespace aftershade::cli
