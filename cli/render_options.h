// --scale, --region, --history-in, --history-out, --graph and --var of `run`.
#pragma once

#include <string>
#include <vector>

#include "framework/pipeline/look.h"
#include "framework/pipeline/run.h"

namespace CLI {
class App;
}  // namespace CLI

namespace aftershade::cli {

struct RenderOptions {
    std::vector<std::string> variables;
    std::string scale = "1";
    std::string region;
    int region_margin_px = 64;
    std::string history_in;
    std::string history_out;
    std::string graph;
};

void add_render_options(CLI::App& app, RenderOptions& options);

/// "--var focus=2.4 m" as values above the look's "vars".
LookVariables parse_variables(const RenderOptions& options, Diagnostics& diagnostics);

/// Puts scale, region and history into `run`; faults of the words go to `diagnostics`.
void apply_render_options(const RenderOptions& options, RunOptions& run, Diagnostics& diagnostics);

/// Whether outputs have other pixels than the source.
bool changes_window(const RenderOptions& options);

/// Writes the graph: .dot as it is, .svg through Graphviz's `dot`. Throws Error(ExitCode::output).
void write_graph(const std::string& path, const std::string& dot);

}  // namespace aftershade::cli
