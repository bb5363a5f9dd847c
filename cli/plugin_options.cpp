#include "cli/plugin_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string_view>
#include <thread>

#include "cli/command_line.h"
#include "framework/batch/worker.h"
#include "framework/core/status.h"
#include "framework/effect/native/native_library.h"

namespace aftershade::cli {

namespace {

using Clock = std::chrono::steady_clock;

/// Raises a flag when nothing was heard for a while, or when the user asked to stop.
class Watchdog {
public:
    Watchdog(std::chrono::duration<double> patience, const std::atomic<bool>& stop)
        : patience_(patience), stop_(stop), heard_(Clock::now()), thread_([this] { watch(); }) {}
    ~Watchdog() {
        done_ = true;
        thread_.join();
    }
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    void heard() { heard_ = Clock::now(); }
    bool barked() const { return barked_; }
    const std::atomic<bool>& flag() const { return flag_; }

private:
    void watch() {
        while (!done_) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            if (stop_) flag_ = true;
            if (!flag_ && Clock::now() - heard_.load() > patience_) {
                barked_ = true;
                flag_ = true;
            }
        }
    }

    const std::chrono::duration<double> patience_;
    const std::atomic<bool>& stop_;
    std::atomic<Clock::time_point> heard_;
    std::atomic<bool> done_ = false, barked_ = false, flag_ = false;
    std::thread thread_;  // last: it uses the others
};

void pass_on(std::FILE* stream, std::string_view line) {
    std::fprintf(stream, "%.*s\n", int(line.size()), line.data());
    std::fflush(stream);
}

ExitCode told(const WorkerResult& result, const Watchdog& watchdog, double timeout_s) {
    if (watchdog.barked()) {
        WorkerResult hung = result;
        hung.end = WorkerEnd::timed_out;
        hung.limits.wall_time = std::chrono::milliseconds(std::int64_t(timeout_s * 1000));
        std::fprintf(stderr, "aftershade: error: %s; give it longer with --plugin-timeout\n",
                     describe(hung).c_str());
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

std::optional<ExitCode> run_in_worker(const PluginOptions& options, const Pipeline& pipeline,
                                      const std::atomic<bool>& stop) {
    const std::vector<std::filesystem::path> given(options.paths.begin(), options.paths.end());
    if (!pipeline.has_native() || native_search_path(given).empty() || std::getenv(kStatusFdVariable))
        return std::nullopt;
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
