// The command line of this process, as a person would type it.
#pragma once

#include <string>
#include <vector>

namespace aftershade::cli {

/// The words that this process was started with. Throws Error(ExitCode::effect) without /proc.
std::vector<std::string> own_arguments();

/// An option and its value, such as {"--frames", "5-10"}; with "" the option goes.
struct OptionValue {
    std::string name;
    std::string value;
};

/// `words` with these options in place of those that were there; they come right after the verb, words[1].
std::vector<std::string> with_options(const std::vector<std::string>& words,
                                      const std::vector<OptionValue>& options);

}  // namespace aftershade::cli
