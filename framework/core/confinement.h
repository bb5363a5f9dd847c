// What the kernel keeps untrusted native code from: Landlock and seccomp, where it has them.
#pragma once

#include <string>
#include <vector>

namespace aftershade {

/// What this kernel offers, or what was applied to a process.
struct Confinement {
    int landlock_abi = 0;  ///< 0: none. Files from 1 on, TCP from 4 on, signals from 6 on (landlock(7))
    bool seccomp = false;  ///< filters of system calls (seccomp(2)), for this processor
};

/// [thread-safe]
Confinement offered_confinement();

/// Confines this process, for good: it may read files, take memory, and start threads. It may not write,
/// make, rename or remove a file, start a process or a program, open a socket, send a signal to another
/// process, look into one, or gain a privilege. Pipes that are open stay open. Returns what the kernel
/// applied. [while the process has one thread: others would stay as they are]
Confinement confine_native_code();

/// What native code can still do, a clause each; what no kernel prevents is not among them.
std::vector<std::string> confinement_gaps(const Confinement& held);

}  // namespace aftershade
