// `aftershade golden apply-approvals`: decisions of a file or of commits.
#pragma once

#include <functional>

#include "cli/exit_code.h"

namespace CLI {
class App;
}  // namespace CLI

namespace aftershade::cli {

/// The verb's options are added to `golden`. Returns what the verb does.
std::function<ExitCode()> add_golden_apply(CLI::App& golden);

}  // namespace aftershade::cli
