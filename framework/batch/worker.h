// A command as a child process that may crash, hang or run away without taking this one along.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/core/status.h"

namespace aftershade {

struct WorkerLimits {
    std::optional<std::chrono::milliseconds> wall_time;  ///< from the start; then the child is killed
    std::optional<std::uint64_t> memory_bytes;  ///< RLIMIT_AS: address space, which is more than RAM used
    std::optional<std::uint64_t> cpu_seconds;   ///< RLIMIT_CPU, of all threads
    std::uint64_t core_bytes = 0;               ///< RLIMIT_CORE: no core files, as a rule
};

struct WorkerCommand {
    /// The first is the program's path. PATH is not searched, and no shell looks at any.
    std::vector<std::string> arguments;
    std::map<std::string, std::string> environment;  ///< added to this process's, or in its place
    WorkerLimits limits;
    /// How long a worker that was asked to end (SIGTERM, after an interrupt) may take before it is killed.
    std::chrono::milliseconds grace{2000};
};

/// What a worker says while it runs; each may be empty. Called on the thread that runs run_worker. A line has
/// no line end; one above 64 KiB comes in pieces.
struct WorkerListener {
    std::function<void(std::string_view line)> on_stdout;
    std::function<void(std::string_view line)> on_stderr;
    std::function<void(const WorkStatus& status)> on_status;
    std::function<void(const FrameEvent& event)> on_frame;
};

enum class WorkerEnd {
    exited,       ///< by itself, with exit_code
    signalled,    ///< by a signal that is not ours: a crash, or a limit of the system
    timed_out,    ///< killed for its wall-clock time
    interrupted,  ///< asked to end, or killed, because of the interrupt flag
};

struct WorkerResult {
    WorkerEnd end = WorkerEnd::exited;
    int exit_code = 0;      ///< exited; also interrupted, where the worker ended by itself
    int signal_number = 0;  ///< signalled
    double seconds = 0;     ///< wall-clock
    WorkStatus status;      ///< the last one; its fields are empty where none came
    WorkerLimits limits;    ///< those of the command, for describe()

    bool succeeded() const { return end == WorkerEnd::exited && exit_code == 0; }
};

/// Runs the command to its end. The child leads a process group of its own; what is left of the group when
/// the child has ended is killed. Its standard input is empty. It dies with the thread that called this.
/// Throws Error(ExitCode::effect) where the program cannot be started, naming it and the system's reason.
/// [thread-safe: several workers may run from several threads]
WorkerResult run_worker(const WorkerCommand& command, const WorkerListener& listener = {},
                        const std::atomic<bool>* interrupt = nullptr);

/// "plug-in /x/libfoo.so crashed (signal 11, SIGSEGV) in prepare of step 'grade', frame 12".
std::string describe(const WorkerResult& result);
/// The same of one that was ended because it was silent for so long.
std::string describe_timeout(WorkerResult result, std::chrono::duration<double> timeout);

/// A line of the status pipe; nullopt for anything that StatusWriter does not write.
std::optional<WorkStatus> parse_status(std::string_view line);
/// Likewise of a frame's end.
std::optional<FrameEvent> parse_event(std::string_view line);

}  // namespace aftershade
