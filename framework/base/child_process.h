// fork and exec: a child with descriptors, an environment and limits of its own.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aftershade {

/// A file descriptor that closes itself.
class Descriptor {
public:
    explicit Descriptor(int number = -1) : number_(number) {}
    ~Descriptor() { reset(); }
    Descriptor(Descriptor&& other) noexcept : number_(other.number_) { other.number_ = -1; }
    Descriptor& operator=(Descriptor&& other) noexcept;

    int get() const { return number_; }
    int release() { return std::exchange(number_, -1); }
    void reset();

private:
    int number_;
};

struct Pipe {
    Descriptor read, write;
};

/// File numbers that spawn_child may give a child: each is above those that a child has. Throws
/// Error(ErrorKind::effect).
Pipe make_pipe();
/// Two ends of a stream that both processes read and write. Throws Error(ErrorKind::effect).
std::pair<Descriptor, Descriptor> make_socket_pair();

struct ChildLimits {
    std::optional<std::uint64_t> memory_bytes;  ///< RLIMIT_AS: address space, which is more than RAM used
    std::optional<std::uint64_t> cpu_seconds;   ///< RLIMIT_CPU, of all threads
    std::optional<std::uint64_t> file_bytes;    ///< RLIMIT_FSIZE, of each file that it writes
    std::uint64_t core_bytes = 0;               ///< RLIMIT_CORE: no core files, as a rule
};

struct ChildCommand {
    /// The first is the program's path. PATH is not searched, and no shell looks at any.
    std::vector<std::string> arguments;
    std::vector<std::string> environment;  ///< "NAME=value"; there is no other
    /// Which of this process's descriptors the child has as 0, 1, 2, ...; -1 for /dev/null. Each comes from
    /// make_pipe or make_socket_pair, or stands in its own place. The child has no others.
    std::vector<int> descriptors;
    ChildLimits limits;
    bool leads_group = false;  ///< of processes, a new one
};

/// The child dies with the thread that called this. Throws Error(ErrorKind::effect) where the program cannot
/// be started, naming it and the system's reason.
pid_t spawn_child(const ChildCommand& command);

/// The path of a program by the folders of $PATH; "" where none has it.
std::string program_on_path(const std::string& program);

/// Waits for a child; returns its status as waitpid(2) has it.
int reap(pid_t process);

/// "(signal 11, SIGSEGV)".
std::string signal_text(int signal_number);

}  // namespace aftershade
