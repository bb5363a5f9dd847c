#include "framework/batch/spawn.h"

#include <fcntl.h>
#include <linux/close_range.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "framework/core/error.h"

extern char** environ;

namespace aftershade {

namespace {

constexpr int kStatusDescriptor = 3;

struct Pipe {
    Descriptor read, write;
};

/// Neither end is 0 to 3, for the child puts its own there.
Pipe make_pipe() {
    const auto fail = [] {
        throw Error(ExitCode::effect,
                    std::string("cannot make a pipe for a worker: ") + std::strerror(errno));
    };
    int ends[2] = {-1, -1};
    if (pipe2(ends, O_CLOEXEC) != 0) fail();
    Pipe pipe{Descriptor(ends[0]), Descriptor(ends[1])};
    for (Descriptor* end : {&pipe.read, &pipe.write}) {
        if (end->get() > kStatusDescriptor) continue;
        const int moved = fcntl(end->get(), F_DUPFD_CLOEXEC, kStatusDescriptor + 1);
        if (moved < 0) fail();
        *end = Descriptor(moved);
    }
    return pipe;
}

std::vector<std::string> child_environment(const WorkerCommand& command) {
    std::map<std::string, std::string> added = command.environment;
    added[kStatusFdVariable] = std::to_string(kStatusDescriptor);
    std::vector<std::string> all;
    for (char** entry = environ; *entry; ++entry) {
        const std::string text = *entry;
        if (!added.contains(text.substr(0, text.find('=')))) all.push_back(text);
    }
    for (const auto& [name, value] : added) all.push_back(name + "=" + value);
    return all;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> all;
    for (std::string& text : texts) all.push_back(text.data());
    all.push_back(nullptr);
    return all;
}

/// All that the child needs, made before the fork: between fork and exec only what signal handlers may call
/// is safe, and that leaves out memory allocation.
struct ChildPlan {
    char** arguments;
    char** environment;
    int out, error, status, report;
    WorkerLimits limits;
    pid_t parent;
};

bool limit(__rlimit_resource_t resource, rlim_t soft, rlim_t hard) {
    const rlimit values{soft, hard};
    return setrlimit(resource, &values) == 0;
}

bool set_limits(const WorkerLimits& limits) {
    bool done = limit(RLIMIT_CORE, limits.core_bytes, limits.core_bytes);
    if (limits.memory_bytes) done = limit(RLIMIT_AS, *limits.memory_bytes, *limits.memory_bytes) && done;
    // SIGXCPU first, which tells why; SIGKILL a second later for who ignores it.
    if (limits.cpu_seconds) done = limit(RLIMIT_CPU, *limits.cpu_seconds, *limits.cpu_seconds + 1) && done;
    return done;
}

[[noreturn]] void become_worker(const ChildPlan& plan) {
    const auto fail = [&] {
        const int reason = errno;
        [[maybe_unused]] const ssize_t written = write(plan.report, &reason, sizeof reason);
        _exit(127);
    };
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != plan.parent) _exit(127);  // it died before the line above could take effect
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    for (const int number : {SIGINT, SIGTERM, SIGPIPE, SIGXCPU}) signal(number, SIG_DFL);
    const int input = open("/dev/null", O_RDONLY);
    if (input < 0 || dup2(input, 0) < 0 || dup2(plan.out, 1) < 0 || dup2(plan.error, 2) < 0 ||
        dup2(plan.status, kStatusDescriptor) < 0)
        fail();
    // Files that a library of this process opened without O_CLOEXEC are no business of the worker's. Kernels
    // before 5.11 lack this, and then the worker has them open.
    close_range(kStatusDescriptor + 1, ~0U, CLOSE_RANGE_CLOEXEC);
    if (!set_limits(plan.limits)) fail();
    execve(plan.arguments[0], plan.arguments, plan.environment);
    fail();
    _exit(127);
}

/// What the child could not do, or 0 once it has become the program.
int start_failure(const Descriptor& report) {
    int reason = 0;
    ssize_t got = 0;
    do got = read(report.get(), &reason, sizeof reason);
    while (got < 0 && errno == EINTR);
    return got == ssize_t(sizeof reason) ? reason : 0;
}

}  // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
    if (this != &other) {
        reset();
        number_ = other.number_;
        other.number_ = -1;
    }
    return *this;
}

void Descriptor::reset() {
    if (number_ >= 0) close(number_);
    number_ = -1;
}

SpawnedWorker spawn_worker(const WorkerCommand& command) {
    if (command.arguments.empty()) throw Error(ExitCode::effect, "a worker's command is empty");
    std::vector<std::string> arguments = command.arguments;
    std::vector<std::string> environment = child_environment(command);
    std::vector<char*> argument_pointers = pointers(arguments);
    std::vector<char*> environment_pointers = pointers(environment);
    Pipe out = make_pipe(), error = make_pipe(), status = make_pipe(), report = make_pipe();
    const ChildPlan plan{
        argument_pointers.data(), environment_pointers.data(), out.write.get(), error.write.get(),
        status.write.get(),       report.write.get(),          command.limits,  getpid()};
    const pid_t process = fork();
    if (process < 0)
        throw Error(ExitCode::effect, arguments[0] + ": cannot start a process: " + std::strerror(errno));
    if (process == 0) become_worker(plan);
    setpgid(process, process);  // here too, so that the group is there whoever comes first
    report.write.reset();
    if (const int reason = start_failure(report.read)) {
        waitpid(process, nullptr, 0);
        throw Error(ExitCode::effect, arguments[0] + ": cannot be run as a worker: " + std::strerror(reason));
    }
    for (const Descriptor* end : {&out.read, &error.read, &status.read})
        fcntl(end->get(), F_SETFL, O_NONBLOCK);
    return {process, std::move(out.read), std::move(error.read), std::move(status.read)};
}

}  // namespace aftershade
