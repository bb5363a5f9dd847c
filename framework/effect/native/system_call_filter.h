// Filters of system calls (seccomp(2)), for a process of untrusted native code.
#pragma once

namespace aftershade {

/// Whether this kernel has them for this processor. [thread-safe]
bool has_system_call_filters();
/// Whether a filter can leave a call to another process's decision (Linux 5.5). [thread-safe]
bool has_thread_notices();

/// From now on each new thread of this process waits for the one that reads the descriptor (ThreadLimit). -1
/// where the kernel refuses: a process has one such filter at most, and a container's host may have set it.
/// Needs PR_SET_NO_NEW_PRIVS, and one thread.
int notice_threads();
/// Allows what libraries need to compute and to read files, within this process; every other call fails with
/// EPERM, for good. False where the kernel refuses. Needs PR_SET_NO_NEW_PRIVS, and one thread.
bool filter_system_calls();

}  // namespace aftershade
