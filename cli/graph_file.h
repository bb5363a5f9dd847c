// The frame graph as a file: --graph of `run`.
#pragma once

#include <string>

namespace aftershade::cli {

/// Throws Error(ErrorKind::output) where `path` ends in .svg and Graphviz's `dot` is not on the PATH: better
/// before the frames than after them.
void require_graph_writer(const std::string& path);

/// Writes a graph in Graphviz's language: .dot as it is, .svg through Graphviz's `dot`. Throws
/// Error(ErrorKind::output).
void write_graph(const std::string& path, const std::string& dot);

}  // namespace aftershade::cli
