// The frame graph as a file: --graph of `run`.
#pragma once

#include <string>

namespace aftershade::cli {

/// Writes a graph in Graphviz's language: .dot as it is, .svg through Graphviz's `dot`. Throws
/// Error(ExitCode::output).
void write_graph(const std::string& path, const std::string& dot);

}  // namespace aftershade::cli
