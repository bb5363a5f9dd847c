// A command as a child process that may crash, hang or run away without taking this one along.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "framework/base/child_process.h"
#include "framework/base/status.h"

namespace aftershade {

struct WorkerLimits : ChildLimits {
    std::optional<std::chrono::milliseconds> wall_time;  ///< from the start; then the child is killed
    /// Memory that the child really uses (RSS), looked at ten times a second; then it is killed. Unlike
    /// `memory_bytes` it leaves alone what GPU drivers reserve.
    std::optional<std::uint64_t> resident_bytes;
};

struct WorkerCommand {
    /// The first is the program's path. PATH is not searched, and no shell looks at any.
    std::vector<std::string> arguments;
    std::map<std::string, std::string> environment;  ///< added to this process's, or in its place
    std::set<std::string> without;                   ///< variables of this process that it does not get
    WorkerLimits limits;
    /// It writes to this process's standard output and error, and the listener hears none of it.
    bool shares_streams = false;
    /// A descriptor of this process, from make_pipe or make_socket_pair, that it has as its standard input,
    /// which is empty otherwise (-1).
    int input = -1;
    /// How long a worker may take to end after SIGTERM (after an interrupt) before it is killed.
    std::chrono::milliseconds grace{2000};
    /// Once raised: the worker hangs, and half a second is all that it is given. May be null.
    const std::atomic<bool>* hangs = nullptr;
};

/// Messages of a worker while it runs; each may be empty. Called on the thread that runs run_worker. A line
/// has no line end; one above 64 KiB comes in pieces.
struct WorkerListener {
    std::function<void(std::string_view line)> on_stdout;
    std::function<void(std::string_view line)> on_stderr;
    std::function<void(const WorkStatus& status)> on_status;
    std::function<void(const FrameEvent& event)> on_frame;
    std::function<void(const ObjectSighting& sighting)> on_object;
    std::function<void(const DrawnBy& gl)> on_gl;
};

enum class WorkerEnd {
    exited,         ///< by itself, with exit_code
    signalled,      ///< by a signal that is not ours: a crash, or a limit of the system
    timed_out,      ///< killed for its wall-clock time
    out_of_memory,  ///< killed for `resident_bytes`
    interrupted,    ///< asked to end, or killed, because of the interrupt flag
};

struct WorkerResult {
    WorkerEnd end = WorkerEnd::exited;
    int exit_code = 0;             ///< exited; also interrupted, where the worker ended by itself
    int signal_number = 0;         ///< signalled
    double seconds = 0;            ///< wall-clock
    WorkStatus status;             ///< the last one; its fields are empty where none came
    std::optional<int> last_word;  ///< the exit code that the worker itself announced, if it did
    WorkerLimits limits;           ///< those of the command, for describe()

    /// Whether any program succeeded; for `aftershade` itself see ended_in_order().
    bool succeeded() const { return end == WorkerEnd::exited && exit_code == 0; }
    /// Whether `aftershade` came to the end of its work: a library that calls exit() gives no last word.
    bool ended_in_order() const { return end == WorkerEnd::exited && last_word == exit_code; }
};

/// Runs the command to its end. The child leads a process group of its own; what is left of the group when
/// the child has ended is killed. It dies with the thread that called this.
/// Throws Error(ErrorKind::effect) where the program cannot be started, naming it and the system's reason.
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
/// Likewise of an object.
std::optional<ObjectSighting> parse_sighting(std::string_view line);
/// Likewise of what it draws with.
std::optional<DrawnBy> parse_drawn_by(std::string_view line);
/// Likewise of a process's last word.
std::optional<int> parse_last_word(std::string_view line);

}  // namespace aftershade
