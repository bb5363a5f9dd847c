// The verbs of the command. Each adds its options to a subcommand and returns what runs when it was chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "framework/core/error.h"

namespace aftershade::cli {

using Verb = std::function<ExitCode()>;

Verb add_run(CLI::App& app);
Verb add_check(CLI::App& app);
Verb add_compare(CLI::App& app);
Verb add_describe(CLI::App& app);
Verb add_docs(CLI::App& app);
Verb add_golden(CLI::App& app);
Verb add_list(CLI::App& app);
Verb add_new(CLI::App& app);
Verb add_render(CLI::App& app);
Verb add_schema(CLI::App& app);
Verb add_inspect(CLI::App& app);
Verb add_doctor(CLI::App& app);

}  // namespace aftershade::cli
