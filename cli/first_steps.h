// What a user can do with a capture alone, without a look.
#pragma once

#include <string>

#include "cli/cli11.h"

namespace aftershade::cli {

/// Whether the word names a JSON document with steps.
bool names_look(const std::string& word);

/// For `aftershade run CAPTURE`: prints the capture's roles, the starting looks that fit and the line to type
/// to stderr. False where `run` was given other words than a capture.
bool print_first_steps(const CLI::App& run);

}  // namespace aftershade::cli
