// `aftershade golden explain`: why a case differs.
#pragma once

#include <functional>

#include "cli/exit_code.h"

namespace CLI {
class App;
}  // namespace CLI

namespace aftershade::cli {

/// The verb's options are added to `golden`. Returns what the verb does.
std::function<ExitCode()> add_golden_explain(CLI::App& golden);

}  // namespace aftershade::cli
