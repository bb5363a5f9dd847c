// Confines untrusted native code by the kernel: Landlock, seccomp and limits, if it has them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace aftershade {

/// Means of confinement that this kernel offers, or that were applied to a process.
struct Confinement {
    int landlock_abi = 0;  ///< 0: none. Files from 1 on, TCP from 4 on, signals from 6 on (landlock(7))
    bool seccomp = false;  ///< filters of system calls (seccomp(2)), for this processor
    bool counts_threads = false;     ///< another process decides on each new thread (ThreadLimit)
    std::uint64_t memory_bytes = 0;  ///< limit of the address space (RLIMIT_AS); 0: none
};

/// [thread-safe]
Confinement offered_confinement();

/// Open files and pipes of a confined process. A pipe holds 64 KiB outside of its address space.
inline constexpr unsigned kMostPluginFiles = 256;

/// Confines this process, for good: it may read files, take memory, and start threads. It may not write,
/// make, rename or remove a file, read a device, start a process or a program, open a socket, send a signal
/// to another process, change or look into one, hold memory that is not in its address space, or gain a
/// privilege. Pipes that are open stay open. `stream`, of sockets, takes what ThreadLimit needs to
/// receive_thread_notices(). Returns what the kernel applied. [while the process has one thread: others would
/// stay as they are]
Confinement confine_native_code(int stream);

/// Actions that native code can still do, a clause each, without those that no kernel prevents.
std::vector<std::string> confinement_gaps(const Confinement& held);

}  // namespace aftershade
