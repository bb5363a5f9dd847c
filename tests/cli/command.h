// Starts the real executable in a folder and keeps what it printed.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/temporary_folder.h"

namespace aftershade::test {

inline const std::vector<std::string> kRgba{"R", "G", "B", "A"};

using Environment = std::map<std::string, std::string>;

struct CommandResult {
    int exit_code = -1;  ///< 128 + signal where one ended the process
    std::string out;
    std::string err;
    double processor_s = 0;        ///< of the process and those that it waited for
    std::uint64_t peak_bytes = 0;  ///< of memory, of the one of them that took most
};

inline std::vector<std::string> lines_of_text(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

/// A running command. Its output goes to files, so that it never waits for a reader.
class Command {
public:
    /// `environment` is put above the test's own, from which AFTERSHADE_* is taken out.
    Command(std::vector<std::string> words, const std::filesystem::path& folder,
            const Environment& environment = {}) {
        std::vector<char*> arguments, variables;
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        std::vector<std::string> settings = merged(environment);
        for (std::string& setting : settings) variables.push_back(setting.data());
        variables.push_back(nullptr);

        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        const int flags = O_WRONLY | O_CREAT | O_TRUNC;
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, (output_ / "out").c_str(), flags, 0600);
        posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, (output_ / "err").c_str(), flags, 0600);
        posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
        const int failure =
            posix_spawn(&process_, words[0].c_str(), &actions, nullptr, arguments.data(), variables.data());
        posix_spawn_file_actions_destroy(&actions);
        if (failure != 0) throw std::runtime_error("cannot start " + words[0]);
    }
    ~Command() {
        if (process_ > 0) kill(process_, SIGKILL), waitpid(process_, nullptr, 0);
    }
    Command(const Command&) = delete;
    Command& operator=(const Command&) = delete;

    pid_t process() const { return process_; }
    void send(int signal) const { kill(process_, signal); }

    /// False if the command ended or ten seconds passed before it had printed that many lines to stdout.
    bool wait_for_lines(std::size_t count) const {
        using namespace std::chrono_literals;
        for (auto waited = 0ms; waited < 10s; waited += 2ms) {
            if (lines_of_text(read_text(output_ / "out")).size() >= count) return true;
            siginfo_t ended{};
            waitid(P_PID, id_t(process_), &ended, WEXITED | WNOHANG | WNOWAIT);
            if (ended.si_pid != 0) return false;
            std::this_thread::sleep_for(2ms);
        }
        return false;
    }

    /// False if ten seconds passed before it had a handler of that signal.
    bool wait_until_it_handles(int signal) const {
        using namespace std::chrono_literals;
        const std::string name = "SigCgt:\t";
        for (auto waited = 0ms; waited < 10s; waited += 2ms) {
            const std::string status = read_text("/proc/" + std::to_string(process_) + "/status");
            const auto at = status.find(name);
            if (at != std::string::npos &&
                std::stoull(status.substr(at + name.size(), 16), nullptr, 16) >> (signal - 1) & 1)
                return true;
            std::this_thread::sleep_for(2ms);
        }
        return false;
    }

    /// What it has printed to stdout so far.
    std::string printed() const { return read_text(output_ / "out"); }

    CommandResult wait() {
        int status = 0;
        rusage used{};
        wait4(process_, &status, 0, &used);
        process_ = 0;
        const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        const auto seconds = [](const timeval& time) {
            return double(time.tv_sec) + double(time.tv_usec) * 1e-6;
        };
        return {code, read_text(output_ / "out"), read_text(output_ / "err"),
                seconds(used.ru_utime) + seconds(used.ru_stime), std::uint64_t(used.ru_maxrss) * 1024};
    }

private:
    static std::vector<std::string> merged(Environment above) {
        // With sanitizers: LeakSanitizer's scan at the end of a process sometimes crashes by itself ("Tracer
        // caught signal 11") beside the threads of Mesa and OpenEXR. Leaks are for the tests that stay in one
        // process.
        above.emplace("LSAN_OPTIONS", "detect_leaks=0:print_suppressions=0");
        // Nothing of the user's, and nothing of another test's.
        above.emplace("AFTERSHADE_CACHE", "off");
        std::vector<std::string> settings;
        for (char** entry = environ; *entry; ++entry) {
            const std::string text = *entry;
            const std::string name = text.substr(0, text.find('='));
            if (!above.contains(name) && !name.starts_with("AFTERSHADE_")) settings.push_back(text);
        }
        for (const auto& [name, value] : above) settings.push_back(name + "=" + value);
        return settings;
    }

    TemporaryFolder output_;
    pid_t process_ = 0;
};

inline std::vector<std::string> aftershade_words(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), AFTERSHADE_EXECUTABLE);
    return arguments;
}

/// On software GL unless `environment` or an argument says otherwise.
inline CommandResult run_aftershade(const std::vector<std::string>& arguments,
                                    const std::filesystem::path& folder, Environment environment = {}) {
    environment.try_emplace("AFTERSHADE_BACKEND", "software");
    return Command(aftershade_words(arguments), folder, environment).wait();
}

/// Every file below `folder` with its bytes; folders have none.
inline std::map<std::string, std::string> contents(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        files[std::filesystem::relative(entry.path(), folder).string()] =
            entry.is_regular_file() ? read_text(entry.path()) : "";
    return files;
}

/// Makes dlopen of GL libraries fail whose names begin with one of `hidden`.
inline Environment without_gl(const std::filesystem::path& folder,
                              const std::vector<std::string>& hidden = {"libOSMesa", "libEGL"}) {
    std::filesystem::create_directories(folder);
    for (const std::string library :
         {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so", "libEGL.so.1", "libEGL.so"})
        for (const std::string& name : hidden)
            if (library.starts_with(name)) write_text(folder / library, "");
    return {{"LD_LIBRARY_PATH", folder.string()}};
}

}  // namespace aftershade::test
