#include "framework/base/child_process.h"

#include <fcntl.h>
#include <linux/close_range.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "framework/base/error.h"
#include "framework/base/text.h"

namespace aftershade {

namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitsMemory = false;  // sanitizers reserve terabytes of addresses when a process starts
#else
constexpr bool kLimitsMemory = true;
#endif

/// More than any child is given.
constexpr int kFirstOwnDescriptor = 8;

[[noreturn]] void refuse(const std::string& what) {
    const int reason = errno;
    const bool is_files = reason == EMFILE || reason == ENFILE;
    const bool is_limit = is_files || reason == EAGAIN || reason == ENOMEM;
    throw Error(is_limit ? ErrorKind::memory : ErrorKind::effect,
                what + ": " + std::strerror(reason) +
                    (is_files   ? " (raise the limit of open files: ulimit -n 256)"
                     : is_limit ? " (raise the limit of processes: ulimit -u; or run less at once)"
                                : ""));
}

[[noreturn]] void fail_to_connect() {
    refuse("cannot make a pipe for a process");
}

Descriptor moved_up(Descriptor descriptor) {
    if (descriptor.get() >= kFirstOwnDescriptor) return descriptor;
    const int moved = fcntl(descriptor.get(), F_DUPFD_CLOEXEC, kFirstOwnDescriptor);
    if (moved < 0) {
        if (errno == EINVAL) errno = EMFILE;  // no number that high is allowed
        fail_to_connect();
    }
    return Descriptor(moved);
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
    const int* descriptors;
    int descriptor_count;
    int report;
    ChildLimits limits;
    bool leads_group;
    pid_t parent;
};

/// A lower limit that the child would inherit anyway stays: root could raise it, others would fail to.
bool limit(__rlimit_resource_t resource, rlim_t soft, rlim_t hard) {
    rlimit inherited{};
    if (getrlimit(resource, &inherited) != 0) return false;
    hard = std::min(hard, inherited.rlim_max);
    const rlimit values{std::min(soft, hard), hard};
    return setrlimit(resource, &values) == 0;
}

bool set_limits(const ChildLimits& limits) {
    bool done = limit(RLIMIT_CORE, limits.core_bytes, limits.core_bytes);
    if (kLimitsMemory && limits.memory_bytes)
        done = limit(RLIMIT_AS, *limits.memory_bytes, *limits.memory_bytes) && done;
    // SIGXCPU first, which tells why; SIGKILL a second later for who ignores it.
    if (limits.cpu_seconds) done = limit(RLIMIT_CPU, *limits.cpu_seconds, *limits.cpu_seconds + 1) && done;
    if (limits.file_bytes) done = limit(RLIMIT_FSIZE, *limits.file_bytes, *limits.file_bytes) && done;
    return done;
}

bool place_descriptors(const ChildPlan& plan) {
    for (int number = 0; number < plan.descriptor_count; ++number) {
        int from = plan.descriptors[number];
        if (from < 0) from = open("/dev/null", number == STDIN_FILENO ? O_RDONLY : O_WRONLY);
        if (from < 0 || dup2(from, number) < 0) return false;
    }
    // Files that a library of this process opened without O_CLOEXEC are no business of the child's. Kernels
    // before 5.11 lack this, and then the child has them open.
    close_range(unsigned(plan.descriptor_count), ~0U, CLOSE_RANGE_CLOEXEC);
    return true;
}

[[noreturn]] void become_child(const ChildPlan& plan) {
    const auto fail = [&] {
        const int reason = errno;
        [[maybe_unused]] const ssize_t written = write(plan.report, &reason, sizeof reason);
        _exit(127);
    };
    if (plan.leads_group) setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != plan.parent) _exit(127);  // it died before the line above could take effect
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    for (const int number : {SIGINT, SIGTERM, SIGPIPE, SIGXCPU}) signal(number, SIG_DFL);
    if (!place_descriptors(plan) || !set_limits(plan.limits)) fail();
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

Pipe make_pipe() {
    int ends[2] = {-1, -1};
    if (pipe2(ends, O_CLOEXEC) != 0) fail_to_connect();
    Descriptor read(ends[0]), write(ends[1]);
    return {moved_up(std::move(read)), moved_up(std::move(write))};
}

std::pair<Descriptor, Descriptor> make_socket_pair() {
    int ends[2] = {-1, -1};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail_to_connect();
    Descriptor mine(ends[0]), theirs(ends[1]);
    return {moved_up(std::move(mine)), moved_up(std::move(theirs))};
}

pid_t spawn_child(const ChildCommand& command) {
    if (command.arguments.empty()) throw Error(ErrorKind::effect, "a process's command is empty");
    std::vector<std::string> arguments = command.arguments;
    std::vector<std::string> environment = command.environment;
    std::vector<char*> argument_pointers = pointers(arguments);
    std::vector<char*> environment_pointers = pointers(environment);
    Pipe report = make_pipe();
    const ChildPlan plan{argument_pointers.data(),   environment_pointers.data(),
                         command.descriptors.data(), int(command.descriptors.size()),
                         report.write.get(),         command.limits,
                         command.leads_group,        getpid()};
    const pid_t process = fork();
    if (process < 0) refuse(arguments[0] + ": cannot start a process");
    if (process == 0) become_child(plan);
    // Here too, so that the group is there whoever comes first.
    if (command.leads_group) setpgid(process, process);
    report.write.reset();
    if (const int reason = start_failure(report.read)) {
        reap(process);
        throw Error(ErrorKind::effect,
                    arguments[0] + ": cannot be run as a worker: " + std::strerror(reason));
    }
    return process;
}

std::string program_on_path(const std::string& program) {
    const char* const path = std::getenv("PATH");
    for (const std::string_view folder : split(path ? path : "/bin:/usr/bin", ':'))
        if (const std::string file = std::string(folder) + "/" + program; access(file.c_str(), X_OK) == 0)
            return file;
    return "";
}

int reap(pid_t process) {
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

std::string signal_text(int signal_number) {
    const char* name = sigabbrev_np(signal_number);
    return "(signal " + std::to_string(signal_number) + (name ? ", SIG" + std::string(name) : "") + ")";
}

}  // namespace aftershade
