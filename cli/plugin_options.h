// --plugin-path and --plugin-timeout, and the process of its own in which plug-ins run.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "framework/core/error.h"
#include "framework/pipeline/pipeline.h"

namespace CLI {
class App;
}  // namespace CLI

namespace aftershade::cli {

struct PluginOptions {
    std::vector<std::string> paths;
    double timeout_s = 60;
};

void add_plugin_options(CLI::App& app, PluginOptions& options);

/// Whether run_in_worker() starts a worker.
bool needs_worker(const PluginOptions& options, const Pipeline& pipeline);

/// Runs this command once more as a worker and passes on what it prints, where some step has native code and
/// there are folders of plug-ins: code from elsewhere may crash or hang, and files that are done must not
/// suffer. Returns the exit code: the worker's, or 5 with a message that names plug-in and step. nullopt: go
/// on in this process, which is the worker or needs none.
std::optional<ExitCode> run_in_worker(const PluginOptions& options, const Pipeline& pipeline,
                                      const std::atomic<bool>& stop);

}  // namespace aftershade::cli
