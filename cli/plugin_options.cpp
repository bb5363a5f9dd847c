#include "cli/plugin_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "cli/command_line.h"
#include "framework/batch/watchdog.h"
#include "framework/batch/worker.h"
#include "framework/core/status.h"
#include "framework/effect/native/native_library.h"

namespace aftershade::cli {

namespace {

void pass_on(std::FILE* stream, std::string_view line) {
    std::fprintf(stream, "%.*s\n", int(line.size()), line.data());
    std::fflush(stream);
}

ExitCode told(const WorkerResult& result, const Watchdog& watchdog, double timeout_s) {
    if (watchdog.barked()) {
        std::fprintf(stderr, "aftershade: error: %s; give it longer with --plugin-timeout\n",
                     describe_timeout(result, std::chrono::duration<double>(timeout_s)).c_str());
        return ExitCode::effect;
    }
    switch (result.end) {
        case WorkerEnd::exited: break;
        case WorkerEnd::interrupted: return ExitCode::interrupted;
        case WorkerEnd::signalled:
        case WorkerEnd::timed_out:
            std::fprintf(stderr, "aftershade: error: %s\n", describe(result).c_str());
            return ExitCode::effect;
    }
    // A plug-in that calls exit() ends the worker in the middle of its code.
    if (!result.status.plugin.empty() && result.exit_code != int(ExitCode::interrupted) &&
        result.exit_code != int(ExitCode::effect)) {
        std::fprintf(stderr, "aftershade: error: %s\n", describe(result).c_str());
        return ExitCode::effect;
    }
    return ExitCode(result.exit_code);
}

}  // namespace

void add_plugin_options(CLI::App& app, PluginOptions& options) {
    app.add_option("--plugin-path", options.paths,
                   "Folder of native plug-ins (*.so), before those of AFTERSHADE_PLUGIN_PATH; repeatable")
        ->allow_extra_args(false);
    app.add_option("--plugin-timeout", options.timeout_s,
                   "Seconds without a sign of work after which a plug-in is taken to hang")
        ->check(CLI::Range(0.1, 1e6))
        ->capture_default_str();
}

bool needs_worker(const PluginOptions& options, const Pipeline& pipeline) {
    const std::vector<std::filesystem::path> given(options.paths.begin(), options.paths.end());
    return pipeline.has_native() && !native_search_path(given).empty() && !std::getenv(kStatusFdVariable);
}

std::optional<ExitCode> run_in_worker(const PluginOptions& options, const Pipeline& pipeline,
                                      const std::atomic<bool>& stop) {
    if (!needs_worker(options, pipeline)) return std::nullopt;
    WorkerCommand command;
    command.arguments = own_arguments();
    command.arguments[0] = "/proc/self/exe";
    Watchdog watchdog(std::chrono::duration<double>(options.timeout_s), stop);
    WorkerListener listener;
    listener.on_stdout = [&](std::string_view line) { watchdog.heard(), pass_on(stdout, line); };
    listener.on_stderr = [&](std::string_view line) { watchdog.heard(), pass_on(stderr, line); };
    listener.on_status = [&](const WorkStatus&) { watchdog.heard(); };
    const WorkerResult result = run_worker(command, listener, &watchdog.flag());
    return told(result, watchdog, options.timeout_s);
}

}  // namespace aftershade::cli
