// Completion scripts of shells, made from the declarations of the command line.
#pragma once

#include <string>

#include "cli/command_tree.h"

namespace aftershade::cli {

/// What `aftershade completion SHELL` prints: commands, options, the words that options take, ids of effects
/// where one is due, and files elsewhere. bash needs no further package; fish and zsh find the script in
/// their folders of completions.
std::string bash_completion(const Command& root);
std::string zsh_completion(const Command& root);
std::string fish_completion(const Command& root);

}  // namespace aftershade::cli
