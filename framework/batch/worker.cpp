#include "framework/batch/worker.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <utility>

#include "framework/base/child_process.h"
#include "framework/base/memory_limit.h"
#include "framework/base/status.h"

namespace aftershade {

namespace {

using Clock = std::chrono::steady_clock;

// A worker's process and its pipes.

struct SpawnedWorker {
    pid_t process = -1;             ///< also the id of its process group
    Descriptor out, error, status;  ///< reading ends, not blocking; of its own streams there are none
};

constexpr int kStatusDescriptor = 3;

std::vector<std::string> child_environment(const WorkerCommand& command) {
    std::map<std::string, std::string> added = command.environment;
    added[kStatusFdVariable] = std::to_string(kStatusDescriptor);
    std::vector<std::string> all;
    for (char** entry = environ; *entry; ++entry) {
        const std::string text = *entry, name = text.substr(0, text.find('='));
        if (!added.contains(name) && !command.without.contains(name)) all.push_back(text);
    }
    for (const auto& [name, value] : added) all.push_back(name + "=" + value);
    return all;
}

/// Throws Error(ErrorKind::effect) where the program cannot be started.
SpawnedWorker spawn_worker(const WorkerCommand& command) {
    Pipe out = make_pipe(), error = make_pipe(), status = make_pipe();
    const bool shares = command.shares_streams;
    ChildCommand child;
    child.arguments = command.arguments;
    child.environment = child_environment(command);
    child.descriptors = {command.input, shares ? STDOUT_FILENO : out.write.get(),
                         shares ? STDERR_FILENO : error.write.get(), status.write.get()};
    child.limits = static_cast<const ChildLimits&>(command.limits);
    child.leads_group = true;
    SpawnedWorker spawned;
    spawned.process = spawn_child(child);
    spawned.status = std::move(status.read);
    if (!shares) {
        spawned.out = std::move(out.read);
        spawned.error = std::move(error.read);
    }
    for (const Descriptor* end : {&spawned.out, &spawned.error, &spawned.status})
        if (end->get() >= 0) fcntl(end->get(), F_SETFL, O_NONBLOCK);
    return spawned;
}

// How late a timeout, an interrupt or a silent end may be noticed.
constexpr int kPollInterval_ms = 20;
constexpr std::size_t kMaxLine = 64 * 1024;

/// Cuts what a pipe brings into lines.
class LineReader {
public:
    LineReader(Descriptor descriptor, std::function<void(std::string_view)> on_line)
        : descriptor_(std::move(descriptor)), on_line_(std::move(on_line)) {}

    int descriptor() const { return descriptor_.get(); }  ///< -1 once the pipe has ended

    /// One piece of what is there, without waiting: a worker that never stops talking must not keep this
    /// process from looking at the clock. False when there is no more for now.
    bool read_some() {
        std::array<char, 16384> buffer;
        if (descriptor_.get() < 0) return false;
        const ssize_t got = read(descriptor_.get(), buffer.data(), buffer.size());
        if (got > 0) take({buffer.data(), std::size_t(got)});
        if (got == 0 || (got < 0 && errno != EINTR && errno != EAGAIN)) descriptor_.reset();
        return got > 0;
    }

    /// All that is left after the end of the worker.
    void finish() {
        while (read_some()) {
        }
        if (!pending_.empty()) deliver();
    }

private:
    void take(std::string_view bytes) {
        while (!bytes.empty()) {
            const std::size_t end = bytes.find('\n');
            pending_.append(bytes.substr(0, end));
            if (end == std::string_view::npos && pending_.size() < kMaxLine) return;
            deliver();
            bytes.remove_prefix(end == std::string_view::npos ? bytes.size() : end + 1);
        }
    }
    void deliver() {
        if (on_line_) on_line_(pending_);
        pending_.clear();
    }

    Descriptor descriptor_;
    std::function<void(std::string_view)> on_line_;
    std::string pending_;
};

/// The child from its start to its end. Leaves no process behind, whatever throws.
class Child {
public:
    explicit Child(pid_t process) : process_(process) {}
    ~Child() {
        if (process_ > 0) finish();
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    bool has_ended() const {
        siginfo_t info{};
        return waitid(P_PID, id_t(process_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
               info.si_pid == process_;
    }
    pid_t process() const { return process_; }
    void signal_group(int number) const { kill(-process_, number); }

    /// Kills what is left of the group before the child is reaped: until then its id, which is the group's,
    /// cannot be given to another process.
    int finish() {
        signal_group(SIGKILL);
        return reap(std::exchange(process_, -1));
    }

private:
    pid_t process_;
};

/// Whether and why the child is being ended by us.
class Ending {
public:
    Ending(const WorkerCommand& command, const std::atomic<bool>* interrupt)
        : command_(command), interrupt_(interrupt) {}

    void look(const Child& child) {
        const auto now = Clock::now();
        if (!ours_ && interrupt_ && *interrupt_) {
            ours_ = true;
            reason_ = WorkerEnd::interrupted;
            asked_at_ = now;
            kill_at_ = now + command_.grace;
            child.signal_group(SIGTERM);
        }
        if (ours_ && command_.hangs && *command_.hangs) kill_at_ = std::min(kill_at_, asked_at_ + kHungGrace);
        const auto& wall_time = command_.limits.wall_time;
        if (!ours_ && wall_time && now >= start_ + *wall_time) {
            ours_ = true;
            reason_ = WorkerEnd::timed_out;
            kill_at_ = now;
        }
        if (!ours_ && uses_too_much(child, now)) {
            ours_ = true;
            reason_ = WorkerEnd::out_of_memory;
            kill_at_ = now;
        }
        if (now >= kill_at_) child.signal_group(SIGKILL);
    }
    WorkerEnd reason_or(WorkerEnd otherwise) const { return ours_ ? reason_ : otherwise; }
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

private:
    bool uses_too_much(const Child& child, Clock::time_point now) {
        const auto& limit = command_.limits.resident_bytes;
        if (!limit || now < look_at_memory_) return false;
        look_at_memory_ = now + std::chrono::milliseconds(100);
        return resident_bytes(child.process()) > *limit;
    }

    static constexpr std::chrono::milliseconds kHungGrace{500};

    const WorkerCommand& command_;
    const std::atomic<bool>* interrupt_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point look_at_memory_ = start_;
    Clock::time_point asked_at_ = start_;  // to end
    bool ours_ = false;
    WorkerEnd reason_ = WorkerEnd::exited;
    Clock::time_point kill_at_ = Clock::time_point::max();
};

void wait_for_news(const std::array<LineReader*, 3>& readers) {
    std::array<pollfd, 3> wanted;
    for (std::size_t index = 0; index < readers.size(); ++index)
        wanted[index] = {readers[index]->descriptor(), POLLIN, 0};  // poll passes over -1
    poll(wanted.data(), wanted.size(), kPollInterval_ms);
    for (LineReader* reader : readers) reader->read_some();
}

}  // namespace

WorkerResult run_worker(const WorkerCommand& command, const WorkerListener& listener,
                        const std::atomic<bool>* interrupt) {
    WorkerResult result;
    result.limits = command.limits;
    Ending ending(command, interrupt);
    SpawnedWorker spawned = spawn_worker(command);
    Child child(spawned.process);
    LineReader out(std::move(spawned.out), listener.on_stdout);
    LineReader error(std::move(spawned.error), listener.on_stderr);
    LineReader status(std::move(spawned.status), [&](std::string_view line) {
        if (const auto code = parse_last_word(line)) {
            result.last_word = code;
            return;
        }
        if (const auto event = parse_event(line)) {
            if (listener.on_frame) listener.on_frame(*event);
            return;
        }
        if (const auto sighting = parse_sighting(line)) {
            if (listener.on_object) listener.on_object(*sighting);
            return;
        }
        if (const auto gl = parse_drawn_by(line)) {
            if (listener.on_gl) listener.on_gl(*gl);
            return;
        }
        const auto parsed = parse_status(line);
        if (!parsed) return;
        result.status = *parsed;
        if (listener.on_status) listener.on_status(*parsed);
    });
    const std::array<LineReader*, 3> readers = {&out, &error, &status};
    while (!child.has_ended()) {
        wait_for_news(readers);
        ending.look(child);
    }
    const int how = child.finish();
    for (LineReader* reader : readers) reader->finish();
    result.seconds = ending.seconds();
    if (WIFEXITED(how)) result.exit_code = WEXITSTATUS(how);
    if (WIFSIGNALED(how)) result.signal_number = WTERMSIG(how);
    result.end = ending.reason_or(WIFSIGNALED(how) ? WorkerEnd::signalled : WorkerEnd::exited);
    return result;
}

}  // namespace aftershade
