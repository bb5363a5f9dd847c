#include "framework/serve/serve_look.h"

#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "cli/capture_options.h"
#include "cli/command_line.h"
#include "cli/effect_options.h"
#include "cli/first_steps.h"
#include "cli/gl_options.h"
#include "cli/interrupt.h"
#include "cli/plugin_options.h"
#include "cli/serve_export.h"
#include "cli/verbs.h"
#include "framework/base/data_path.h"
#include "framework/base/error.h"
#include "framework/base/memory_limit.h"
#include "framework/batch/watchdog.h"
#include "framework/batch/worker.h"
#include "framework/serve/drawer.h"

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

/// Set for a process that draws, which has the command line of the one that speaks HTTP.
constexpr const char* kDrawsVariable = "AFTERSHADE_SERVE_DRAWS";
/// Its value in the process that draws thumbnails.
constexpr const char* kThumbnails = "thumbnails";

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

/// Runs this command once more as a process that draws, until `stop` at the latest.
serve::DrawerEnd run_drawer(const char* what, int socket, PassLimit limit, bool read_only,
                            const std::atomic<bool>& stop) {
    WorkerCommand command;
    command.arguments = own_arguments();
    command.arguments[0] = "/proc/self/exe";
    command.environment[kDrawsVariable] = what;
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

/// The words as they are meant: a single one is the capture.
ServeArguments completed(ServeArguments arguments) {
    if (!arguments.capture.capture.empty()) return arguments;
    if (arguments.look.empty())
        throw Error(ErrorKind::usage, "CAPTURE is missing: aftershade serve [LOOK] CAPTURE");
    if (names_look(arguments.look))
        throw Error(ErrorKind::usage, "CAPTURE is missing behind the look '" + arguments.look +
                                          "': aftershade serve " + arguments.look + " CAPTURE");
    arguments.capture.capture = std::exchange(arguments.look, "");
    return arguments;
}

serve::LookModel::File kind_of_file(const std::string& look) {
    using File = serve::LookModel::File;
    if (look.empty()) return File::unnamed;
    std::error_code failure;
    if (std::filesystem::symlink_status(look, failure).type() != std::filesystem::file_type::not_found)
        return File::there;
    const std::filesystem::path folder = std::filesystem::absolute(look).parent_path();
    if (!look.ends_with(".json"))
        throw Error(ErrorKind::usage, look + ": no such file; a new look's name ends in .json");
    if (!std::filesystem::is_directory(folder, failure))
        throw Error(ErrorKind::usage, look + ": there is no folder " + folder.string() + " to make it in");
    return File::fresh;
}

/// The options for another capture: the frames and files that the command names apply only to its own.
CaptureOptions options_for(CaptureOptions options, const std::string& capture) {
    if (capture != options.capture) {
        options.capture = capture;
        options.frames.clear();
        options.role_files.clear();
    }
    return options;
}

Sequence open_sequence(const CaptureOptions& options, const std::vector<Profile>& profiles) {
    Diagnostics faults;
    auto sequence = find_sequence(options, profiles, faults);
    if (!sequence || faults.has_errors()) {
        std::ostringstream text;
        faults.print(text);
        throw Error(ErrorKind::capture, text.str());
    }
    return std::move(*sequence);
}

serve::ServeOptions serve_options(const ServeArguments& arguments, Diagnostics& diagnostics) {
    serve::ServeOptions options;
    options.profiles = load_profiles(arguments.capture.profile_paths, diagnostics);
    find_sequence(arguments.capture, options.profiles, diagnostics);  // for its faults, beside the others'
    stop_at_errors(diagnostics);
    options.look = arguments.look.empty() ? "untitled.json" : arguments.look;
    options.look_file = kind_of_file(arguments.look);
    options.capture = arguments.capture.capture;
    options.open_sequence = [capture = arguments.capture,
                             profiles = options.profiles](const std::string& name) {
        return open_sequence(options_for(capture, name), profiles);
    };
    options.limits = arguments.capture.limits;
    options.gl = chosen_gl(arguments.gl);
    options.data_folder = data_path();
    options.effect_folders.assign(arguments.effect_paths.begin(), arguments.effect_paths.end());
    options.port = arguments.port;
    options.read_only = arguments.read_only;
    return options;
}

/// The work of a process that draws, which ends with its socket.
ExitCode draw(serve::ServeOptions& options, bool is_for_thumbnails) {
    constexpr int kLeastUrgent = 19;
    if (is_for_thumbnails) setpriority(PRIO_PROCESS, 0, kLeastUrgent);
    else options.drawn_by = warn_of_software;
    serve::draw_for(options, STDIN_FILENO);
    return ExitCode::done;
}

/// The work of a process that exports.
ExitCode export_frames(const ServeArguments& arguments) {
    const serve::ExportJob job = read_export_job();
    RunArguments run;
    run.capture = options_for(arguments.capture, job.capture);
    run.gl = arguments.gl;
    run.effect_paths = arguments.effect_paths;
    run.plugins = arguments.limits;
    return run_export(job, std::move(run));
}

ExitCode serve(const ServeArguments& words) {
    const char* const draws = std::getenv(kDrawsVariable);
    share_one_heap();
    const ServeArguments arguments = completed(words);
    if (std::getenv(kExportVariable)) return export_frames(arguments);
    Diagnostics diagnostics;
    if (!draws) find_effects(arguments.effect_paths, diagnostics);  // for its faults and warnings
    serve::ServeOptions options = serve_options(arguments, diagnostics);
    if (draws) return draw(options, std::string_view(draws) == kThumbnails);
    diagnostics.print(std::cerr);
    const std::atomic<bool>& stop = watch_for_interrupt();
    const auto runner = [&](const char* what) {
        return [&arguments, &stop, what](int socket) {
            return run_drawer(what, socket, arguments.limits.pass_limit(), arguments.read_only, stop);
        };
    };
    options.run_drawer = runner("1");
    options.run_thumbnail_drawer = runner(kThumbnails);
    options.run_export = export_runner(arguments.limits.pass_limit());
    if (options.look_file == serve::LookModel::File::fresh)
        std::cerr << arguments.look << ": the page makes it when it saves\n";
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
    app.add_option("look", arguments->look,
                   "The look that the page shows and saves; without one it begins without steps, and the "
                   "first save needs a name");
    add_capture_argument(app, arguments->capture)->required(false);
    app.add_option("--port", arguments->port, "Port of 127.0.0.1; 0 takes a free one")
        ->check(CLI::Range(0, 65535))
        ->capture_default_str();
    app.add_flag("--open", arguments->opens, "Open the page in the desktop's browser");
    app.add_flag("--read-only", arguments->read_only,
                 "Write no file: neither the look nor a shader, and no cache");
    add_capture_options(app, arguments->capture, "Frames to show, such as 1-24 (default: the capture's)");
    add_effect_path_option(app, arguments->effect_paths);
    add_ocio_option(app);
    add_pass_timeout_option(app, arguments->limits);
    add_gl_options(app, arguments->gl);
    return [arguments] { return serve(*arguments); };
}

}  // namespace aftershade::cli
