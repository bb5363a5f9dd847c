// What the commands that approve images have in common.
#pragma once

#include <string>

#include "cli/golden_options.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace aftershade::cli {

/// `aftershade golden approve` of the suite, as its sidecars name it, whichever command approves.
std::string approve_command(const GoldenSetup& setup);

/// Cases that keep their goldens and sums on stderr, paths of new files on stdout.
void print_approval(const GoldenApproval& approval);

void add_approver_option(CLI::App& app, GoldenOptions& options);
void add_any_renderer_option(CLI::App& app, GoldenOptions& options);
CLI::Option* add_page_limit(CLI::App& app, GoldenOptions& options);

}  // namespace aftershade::cli
