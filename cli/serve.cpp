#include "framework/serve/serve.h"

#include <spawn.h>
#include <sys/wait.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <thread>

#include "cli/capture_options.h"
#include "cli/effect_options.h"
#include "cli/gl_options.h"
#include "cli/interrupt.h"
#include "cli/plugin_options.h"
#include "cli/restart.h"
#include "cli/verbs.h"
#include "framework/batch/watchdog.h"
#include "framework/batch/worker.h"
#include "framework/core/data_path.h"
#include "framework/core/error.h"
#include "framework/core/memory_limit.h"
#include "framework/core/status.h"

extern char** environ;

namespace aftershade::cli {

namespace {

struct ServeArguments {
    std::string look;
    CaptureOptions capture;
    std::string backend;
    std::vector<std::string> effect_paths;
    int port = 0;
    bool opens = false;
    bool read_only = false;
    PluginOptions limits;
};

/// By the desktop's own command; where there is none, the address that was printed does.
void open_browser(const std::string& address) {
    std::string command = "xdg-open", copy = address;
    char* words[] = {command.data(), copy.data(), nullptr};
    pid_t id = 0;
    if (posix_spawnp(&id, "xdg-open", nullptr, nullptr, words, environ) != 0) {
        std::cerr << "--open: there is no xdg-open here; open the address above\n";
        return;
    }
    std::thread([id] { waitpid(id, nullptr, 0); }).detach();
}

/// Why the picture at work was given up; "" where it was not.
std::string reason_of(const Watchdog& watchdog) {
    if (!watchdog.barked()) return "";
    WorkerResult at_bark;
    at_bark.status = watchdog.status_at_bark();
    return describe_timeout(at_bark, watchdog.timeout()) +
           "; change the look or the shader, or allow more time with --pass-timeout";
}

ExitCode serve(const ServeArguments& arguments) {
    if (const auto code = run_in_worker(arguments.limits, !arguments.effect_paths.empty())) return *code;
    share_one_heap();
    const std::string handover = state_before_restart();
    Watchdog watchdog(Watchdog::Duration::max(), arguments.limits.pass_limit(), watch_for_interrupt());
    StatusWriter status([&](const WorkStatus& now) { watchdog.is_at(now); });
    const gpu::Backend backend = chosen_backend(arguments.backend);
    Diagnostics diagnostics;
    find_effects(arguments.effect_paths, diagnostics);  // for its faults and warnings
    const std::vector<Profile> profiles = load_profiles(arguments.capture.profile_paths, diagnostics);
    const auto sequence = find_sequence(arguments.capture, profiles, diagnostics);
    stop_at_errors(diagnostics);
    diagnostics.print(std::cerr);
    serve::ServeOptions options;
    options.look = arguments.look;
    options.capture = arguments.capture.capture;
    options.sequence = *sequence;
    options.profiles = profiles;
    options.limits = arguments.capture.limits;
    options.backend = backend;
    options.data_folder = data_path();
    options.effect_folders.assign(arguments.effect_paths.begin(), arguments.effect_paths.end());
    options.port = arguments.port;
    options.read_only = arguments.read_only;
    options.status = &status;
    options.hang = [&] { return reason_of(watchdog); };
    options.restart = [&](const std::string& state) {
        std::cerr << "aftershade: warning: " << reason_of(watchdog) << "; the server starts again\n";
        restart(state);
    };
    options.handover = handover;
    options.ready = [&](const std::string& address) {
        std::cout << address << std::endl;
        std::cerr << "the page is at the address above, for this machine alone; interrupt to end\n";
        if (arguments.opens) open_browser(address);
    };
    serve::serve(options, watchdog.flag());
    return ExitCode::interrupted;
}

}  // namespace

Verb add_serve(CLI::App& app) {
    auto arguments = std::make_shared<ServeArguments>();
    app.add_option("look", arguments->look, "The look that the page shows and saves")->required();
    add_capture_argument(app, arguments->capture);
    app.add_option("--port", arguments->port, "Port of 127.0.0.1; 0 takes a free one")
        ->check(CLI::Range(0, 65535))
        ->capture_default_str();
    app.add_flag("--open", arguments->opens, "Open the page in the desktop's browser");
    app.add_flag("--read-only", arguments->read_only, "Never write the look or a shader");
    add_capture_options(app, arguments->capture, "Frames to show, such as 1-24 (default: the capture's)");
    add_effect_path_option(app, arguments->effect_paths);
    add_pass_timeout_option(app, arguments->limits);
    add_backend_option(app, arguments->backend);
    return [arguments] { return serve(*arguments); };
}

}  // namespace aftershade::cli
