#include "framework/serve/serve_look.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "cli/capture_options.h"
#include "cli/command_line.h"
#include "cli/effect_options.h"
#include "cli/gl_options.h"
#include "cli/interrupt.h"
#include "cli/plugin_options.h"
#include "cli/verbs.h"
#include "framework/base/data_path.h"
#include "framework/base/error.h"
#include "framework/base/memory_limit.h"
#include "framework/batch/watchdog.h"
#include "framework/batch/worker.h"
#include "framework/serve/drawer.h"

extern char** environ;

namespace aftershade::cli {

namespace {

struct ServeArguments {
    std::string look;
    CaptureOptions capture;
    GlOptions gl;
    std::vector<std::string> effect_paths;
    int port = 0;
    bool opens = false;
    bool read_only = false;
    PluginOptions limits;
};

/// Leads a browser to the page. Every user of the machine sees the words of a command, and the address has
/// the token in it: so the browser gets a file that only this user can read, which is removed with this.
class OpenedBrowser {
public:
    explicit OpenedBrowser(const std::string& address) {
        const char* const runtime = std::getenv("XDG_RUNTIME_DIR");
        std::error_code failure;
        if (!(runtime && *runtime && write_page(runtime, address)) &&
            !write_page(std::filesystem::temp_directory_path(failure), address)) {
            std::cerr
                << "--open: neither $XDG_RUNTIME_DIR nor the folder for temporary files takes a file; open "
                   "the address above\n";
            return;
        }
        std::string command = "xdg-open", page = "file://" + file_;
        char* words[] = {command.data(), page.data(), nullptr};
        pid_t id = 0;
        if (posix_spawnp(&id, "xdg-open", nullptr, nullptr, words, environ) != 0) {
            std::cerr << "--open: there is no xdg-open here; open the address above\n";
            return;
        }
        std::thread([id] { waitpid(id, nullptr, 0); }).detach();
    }
    ~OpenedBrowser() {
        if (!file_.empty()) unlink(file_.c_str());
    }
    OpenedBrowser(const OpenedBrowser&) = delete;
    OpenedBrowser& operator=(const OpenedBrowser&) = delete;

private:
    bool write_page(const std::filesystem::path& folder, const std::string& address) {
        constexpr std::string_view kEnding = ".html";
        std::string name = (folder / "aftershade-XXXXXX").string() + std::string(kEnding);
        const int file = mkstemps(name.data(), int(kEnding.size()));  // for its owner alone (mkstemps(3))
        if (file < 0) return false;
        file_ = name;
        const std::string text =
            "<!DOCTYPE html><meta charset=\"utf-8\"><title>Aftershade</title>"
            "<meta http-equiv=\"refresh\" content=\"0;url=" +
            address + "\">\n";
        const bool is_whole = ::write(file, text.data(), text.size()) == ssize_t(text.size());
        close(file);
        return is_whole;
    }

    std::string file_;
};

/// Set for the process that draws, which has the command line of the one that speaks HTTP.
constexpr const char* kDrawsVariable = "AFTERSHADE_SERVE_DRAWS";

serve::DrawerEnd end_of(const WorkerResult& result, const Watchdog& watchdog) {
    if (watchdog.barked()) {
        WorkerResult at_bark;
        at_bark.status = watchdog.status_at_bark();
        return {describe_timeout(at_bark, watchdog.timeout()), at_bark.status.step, true};
    }
    const bool is_memory =
        result.end == WorkerEnd::out_of_memory || result.exit_code == int(ExitCode::memory);
    return {describe(result), result.status.step, false, is_memory ? ErrorKind::memory : ErrorKind::effect};
}

/// Runs this command once more as the process that draws, until `stop` at the latest.
serve::DrawerEnd run_drawer(int socket, PassLimit limit, bool read_only, const std::atomic<bool>& stop) {
    WorkerCommand command;
    command.arguments = own_arguments();
    command.arguments[0] = "/proc/self/exe";
    command.environment[kDrawsVariable] = "1";
    if (read_only)  // whose promise covers the caches of compiled shaders: ours, Mesa's and NVIDIA's
        for (const auto& [name, value] : {std::pair{"AFTERSHADE_CACHE", "off"},
                                          {"MESA_SHADER_CACHE_DISABLE", "true"},
                                          {"__GL_SHADER_DISK_CACHE", "0"}})
            command.environment[name] = value;
    command.shares_streams = true;
    command.input = socket;
    command.limits.resident_bytes = foreign_memory_bytes();
    command.grace = std::chrono::milliseconds(0);  // it has nothing to write
    Watchdog watchdog(Watchdog::Duration::max(), limit, stop);
    WorkerListener listener;
    listener.on_status = [&](const WorkStatus& status) { watchdog.is_at(status); };
    const WorkerResult result = run_worker(command, listener, &watchdog.flag());
    const serve::DrawerEnd end = end_of(result, watchdog);
    if (!stop && !result.ended_in_order())
        std::cerr << "aftershade: warning: " << end.reason << "; the process that draws starts again\n";
    return end;
}

ExitCode serve(const ServeArguments& arguments) {
    const bool draws = std::getenv(kDrawsVariable) != nullptr;
    share_one_heap();
    Diagnostics diagnostics;
    if (!draws) find_effects(arguments.effect_paths, diagnostics);  // for its faults and warnings
    const std::vector<Profile> profiles = load_profiles(arguments.capture.profile_paths, diagnostics);
    const auto sequence = find_sequence(arguments.capture, profiles, diagnostics);
    stop_at_errors(diagnostics);
    serve::ServeOptions options;
    options.look = arguments.look;
    options.capture = arguments.capture.capture;
    options.sequence = *sequence;
    options.profiles = profiles;
    options.limits = arguments.capture.limits;
    options.gl = chosen_gl(arguments.gl);
    options.drawn_by = warn_of_software;
    options.data_folder = data_path();
    options.effect_folders.assign(arguments.effect_paths.begin(), arguments.effect_paths.end());
    options.port = arguments.port;
    options.read_only = arguments.read_only;
    if (draws) {
        serve::draw_for(options, STDIN_FILENO);
        return ExitCode::done;
    }
    diagnostics.print(std::cerr);
    const std::atomic<bool>& stop = watch_for_interrupt();
    options.run_drawer = [&](int socket) {
        return run_drawer(socket, arguments.limits.pass_limit(), arguments.read_only, stop);
    };
    std::optional<OpenedBrowser> browser;
    options.ready = [&](const std::string& address) {
        std::cout << address << std::endl;
        std::cerr << "the page is at the address above, for this machine alone; interrupt to end\n";
        if (arguments.opens) browser.emplace(address);
    };
    options.opened = [&] { browser.reset(); };
    serve::serve(options, stop);
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
    app.add_flag("--read-only", arguments->read_only,
                 "Write no file: neither the look nor a shader, and no cache");
    add_capture_options(app, arguments->capture, "Frames to show, such as 1-24 (default: the capture's)");
    add_effect_path_option(app, arguments->effect_paths);
    add_pass_timeout_option(app, arguments->limits);
    add_gl_options(app, arguments->gl);
    return [arguments] { return serve(*arguments); };
}

}  // namespace aftershade::cli
