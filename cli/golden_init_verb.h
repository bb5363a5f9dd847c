// `aftershade golden init`: a suite of one case, whose tolerance is measured.
#pragma once

#include <functional>

#include "cli/exit_code.h"

namespace CLI {
class App;
}  // namespace CLI

namespace aftershade::cli {

/// The verb's options are added to `golden`. Returns what the verb does.
std::function<ExitCode()> add_golden_init(CLI::App& golden);

}  // namespace aftershade::cli
