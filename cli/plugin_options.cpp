#include "cli/plugin_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>

#include "cli/command_line.h"
#include "cli/interrupt.h"
#include "cli/number_options.h"
#include "framework/base/memory_limit.h"
#include "framework/batch/worker.h"

namespace aftershade::cli {

namespace {

std::vector<std::filesystem::path> search_path(const PluginOptions& options) {
    return native_search_path({options.paths.begin(), options.paths.end()});
}

ExitCode fail(ExitCode code, const std::string& text) {
    std::fprintf(stderr, "aftershade: error: %s\n", text.c_str());
    return code;
}

ExitCode code_of(WorkerResult result, const Watchdog& watchdog) {
    if (watchdog.barked() && watchdog.barked_at_pass()) result.status = watchdog.status_at_bark();
    if (watchdog.barked())
        return fail(ExitCode::effect, describe_timeout(result, watchdog.timeout()) +
                                          "; make the pass cheaper, or give it longer with --pass-timeout");
    switch (result.end) {
        case WorkerEnd::interrupted: return ExitCode::interrupted;
        case WorkerEnd::out_of_memory: return fail(ExitCode::memory, describe(result));
        case WorkerEnd::signalled:
        case WorkerEnd::timed_out: return fail(ExitCode::effect, describe(result));
        case WorkerEnd::exited: break;
    }
    if (result.ended_in_order() || result.exit_code == int(ExitCode::memory))
        return ExitCode(result.exit_code);
    return fail(ExitCode::effect, describe(result) + " before its work was done");
}

}  // namespace

PassLimit PluginOptions::pass_limit() const {
    return {std::chrono::duration<double>(pass_timeout_s), limits_every_pass};
}

void add_plugin_options(CLI::App& app, PluginOptions& options) {
    app.add_option(
           "--plugin-path", options.paths,
           "Search this folder for native plug-ins (*.so) before those of AFTERSHADE_PLUGIN_PATH; repeatable")
        ->allow_extra_args(false);
    app.add_option("--plugin-timeout", options.timeout_s, "Time limit per call of a plug-in, in seconds")
        ->check(CLI::Range(0.1, 1e6))
        ->capture_default_str();
    takes_bytes(app.add_option("--plugin-memory", options.memory_bytes,
                               "Limit the address space of the plug-in process (default: 4GB)"));
    add_pass_timeout_option(app, options);
}

void add_pass_timeout_option(CLI::App& app, PluginOptions& options) {
    app.add_option_function<double>(
           "--pass-timeout",
           [&options](double seconds) {
               options.pass_timeout_s = seconds;
               options.limits_every_pass = true;
           },
           "Time limit for a pass to compile or to draw, in seconds (default: 60 for effects that are not "
           "shipped, none for shipped ones)")
        ->check(CLI::Range(0.1, 1e6));
}

std::optional<ExitCode> run_in_worker(const PluginOptions& options, bool is_foreign) {
    if (std::getenv(kStatusFdVariable)) return std::nullopt;
    if (!is_foreign && !options.limits_every_pass && search_path(options).empty()) return std::nullopt;
    WorkerCommand command;
    command.arguments = own_arguments();
    command.arguments[0] = "/proc/self/exe";
    command.shares_streams = true;
    if (is_foreign) command.limits.resident_bytes = foreign_memory_bytes();
    // What an interrupted worker waits for has limits of its own.
    const double longest_s = std::max(options.timeout_s, options.pass_timeout_s) + 2;
    command.grace = std::chrono::milliseconds(std::int64_t(longest_s * 1000));
    Watchdog watchdog(Watchdog::Duration::max(), options.pass_limit(), watch_for_interrupt());
    command.hangs = &watchdog.barked_flag();
    WorkerListener listener;
    listener.on_status = [&](const WorkStatus& status) { watchdog.is_at(status); };
    return code_of(run_worker(command, listener, &watchdog.flag()), watchdog);
}

std::uint64_t foreign_memory_bytes() {
    return machine_memory_bytes() / 4 * 3;
}

NativeProcessOptions native_process_options(const PluginOptions& options) {
    NativeProcessOptions settings;
    settings.command = {"/proc/self/exe", kNativeHostWord};
    settings.timeout = std::chrono::duration<double>(options.timeout_s);
    settings.memory_bytes = options.memory_bytes;
    return settings;
}

NativeRegistry native_registry(const PluginOptions& options, StatusWriter* status) {
    std::vector<std::filesystem::path> folders = search_path(options);
    std::shared_ptr<NativeProcess> process;
    if (!folders.empty()) process = std::make_shared<NativeProcess>(native_process_options(options));
    return NativeRegistry(std::move(folders), shipped_native_libraries(), status, std::move(process));
}

}  // namespace aftershade::cli
