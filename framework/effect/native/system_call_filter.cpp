#include "framework/effect/native/system_call_filter.h"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/futex.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <initializer_list>
#include <vector>

namespace aftershade {

namespace {

// ---- seccomp: a list of what is allowed; everything else is refused with EPERM ----

#if defined(__x86_64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kArchitecture = 0;
#endif

/// What loaders, C and C++ libraries and threads need, and what reads files.
constexpr std::array kAllowed = {
    SYS_read,
    SYS_readv,
    SYS_pread64,
    SYS_preadv,
    SYS_write,
    SYS_writev,
    SYS_close,
    SYS_lseek,
    SYS_fstat,
    SYS_newfstatat,
    SYS_statx,
    SYS_faccessat,
    SYS_faccessat2,
    SYS_readlinkat,
    SYS_getcwd,
    SYS_getdents64,
    SYS_statfs,
    SYS_fstatfs,
    SYS_dup,
    SYS_dup3,
    SYS_pipe2,
    SYS_ppoll,
    SYS_pselect6,
    SYS_epoll_create1,
    SYS_epoll_ctl,
    SYS_epoll_pwait,
    SYS_eventfd2,
    SYS_mmap,
    SYS_mprotect,
    SYS_munmap,
    SYS_mremap,
    SYS_madvise,
    SYS_brk,
    SYS_mincore,
    SYS_mlock,
    SYS_munlock,
    SYS_membarrier,
    SYS_set_robust_list,
    SYS_rseq,
    SYS_set_tid_address,
    SYS_exit,
    SYS_exit_group,
    SYS_sched_yield,
    SYS_sched_getaffinity,
    SYS_sched_getparam,
    SYS_sched_getscheduler,
    SYS_sched_get_priority_max,
    SYS_sched_get_priority_min,
    SYS_getpriority,
    SYS_getcpu,
    SYS_getpid,
    SYS_gettid,
    SYS_getppid,
    SYS_getpgid,
    SYS_getuid,
    SYS_geteuid,
    SYS_getgid,
    SYS_getegid,
    SYS_getrandom,
    SYS_clock_gettime,
    SYS_clock_getres,
    SYS_clock_nanosleep,
    SYS_nanosleep,
    SYS_gettimeofday,
    SYS_times,
    SYS_getrusage,
    SYS_sysinfo,
    SYS_uname,
    SYS_rt_sigaction,
    SYS_rt_sigprocmask,
    SYS_rt_sigreturn,
    SYS_rt_sigtimedwait,
    SYS_rt_sigsuspend,
    SYS_rt_sigpending,
    SYS_sigaltstack,
    SYS_restart_syscall,
    SYS_setitimer,
    SYS_timer_create,
    SYS_timer_settime,
    SYS_timer_delete,
    SYS_timerfd_create,
    SYS_timerfd_settime,
#if defined(__x86_64__)
    SYS_stat,
    SYS_lstat,
    SYS_access,
    SYS_readlink,
    SYS_getdents,
    SYS_dup2,
    SYS_pipe,
    SYS_poll,
    SYS_select,
    SYS_epoll_create,
    SYS_epoll_wait,
    SYS_eventfd,
    SYS_arch_prctl,
    SYS_time,
    SYS_alarm,
    SYS_pause,
    SYS_getrlimit,
    SYS_getpgrp,
#endif
};

/// A call that is allowed where one of its arguments, seen as 32 bits, is one of the values once the bits
/// that the mask leaves out are 0.
struct Guarded {
    long call = 0;
    unsigned argument = 0;
    std::vector<std::uint32_t> values;
    std::uint32_t mask = ~0u;
};

constexpr std::uint32_t kWrites = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND;
/// What a thread is, and what the C libraries may ask of one besides; CLONE_DETACHED is musl's.
constexpr std::uint32_t kThread = CLONE_THREAD | CLONE_VM | CLONE_SIGHAND;
constexpr std::uint32_t kOfThreads = CLONE_FS | CLONE_FILES | CLONE_SYSVSEM | CLONE_SETTLS |
                                     CLONE_PARENT_SETTID | CLONE_CHILD_SETTID | CLONE_CHILD_CLEARTID |
                                     CLONE_DETACHED;

/// Waiting is harmless anywhere. The others could take over who waits in a file that processes share, so they
/// are for this process's own memory.
std::vector<std::uint32_t> futex_operations() {
    std::vector<std::uint32_t> allowed = {FUTEX_WAIT, FUTEX_WAIT_BITSET};
    for (std::uint32_t operation = FUTEX_WAIT; operation <= FUTEX_LOCK_PI2; ++operation)
        allowed.push_back(operation | FUTEX_PRIVATE_FLAG);
    return allowed;
}

std::vector<Guarded> guarded_calls() {
    const auto self = std::uint32_t(getpid());
    return {
        {SYS_openat, 2, {0}, kWrites},
#if defined(__x86_64__)
            {SYS_open, 1, {0}, kWrites},
#endif
            {SYS_futex, 1, futex_operations(), ~std::uint32_t(FUTEX_CLOCK_REALTIME)},
            {SYS_clone, 0, {kThread}, ~kOfThreads}, {SYS_tgkill, 0, {self}}, {SYS_kill, 0, {self}},
            {SYS_sched_setaffinity, 0, {0, self}},
            // All but to drop a file from memory, which others read too.
            {SYS_fadvise64,
             3,
             {POSIX_FADV_NORMAL, POSIX_FADV_RANDOM, POSIX_FADV_SEQUENTIAL, POSIX_FADV_WILLNEED,
              POSIX_FADV_NOREUSE}},
            {SYS_ioctl, 1, {TCGETS, FIONREAD, FIOCLEX, FIONCLEX, TIOCGWINSZ}},
            {SYS_fcntl, 1, {F_DUPFD, F_GETFD, F_SETFD, F_GETFL, F_SETFL, F_DUPFD_CLOEXEC}},
            {SYS_prctl, 0, {PR_SET_NAME, PR_GET_NAME, PR_GET_DUMPABLE, PR_GET_PDEATHSIG}},
    };
}

constexpr std::uint32_t kAllow = SECCOMP_RET_ALLOW, kRefuse = SECCOMP_RET_ERRNO | EPERM,
                        kUnknown = SECCOMP_RET_ERRNO | ENOSYS;

sock_filter load(std::size_t offset) {
    return BPF_STMT(BPF_LD | BPF_W | BPF_ABS, std::uint32_t(offset));
}
sock_filter ret(std::uint32_t action) {
    return BPF_STMT(BPF_RET | BPF_K, action);
}
/// Goes on with the next instruction where the word equals `value`, else passes over `skipped`.
sock_filter unless_equal(std::uint32_t value, std::uint8_t skipped) {
    return BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, skipped);
}

std::size_t offset_of_argument(unsigned argument, bool upper_half) {
    const bool later = upper_half == (std::endian::native == std::endian::little);
    return offsetof(seccomp_data, args) + 8 * argument + (later ? 4 : 0);
}

class Filter {
public:
    Filter() {
        add({load(offsetof(seccomp_data, arch)), unless_equal(kArchitecture, 1),
             BPF_JUMP(BPF_JMP | BPF_JA, 1, 0, 0), ret(SECCOMP_RET_KILL_PROCESS),
             load(offsetof(seccomp_data, nr))});
        for (const long call : kAllowed) add({unless_equal(std::uint32_t(call), 1), ret(kAllow)});
        for (const Guarded& call : guarded_calls()) add(call);
        limit_reading();
        // The C library takes clone, whose flags a filter can see.
        add({unless_equal(SYS_clone3, 1), ret(kUnknown), ret(kRefuse)});
    }
    sock_fprog program() { return {static_cast<unsigned short>(code_.size()), code_.data()}; }

private:
    void add(std::initializer_list<sock_filter> instructions) { code_.insert(code_.end(), instructions); }

    void add(const Guarded& call) {
        std::vector<sock_filter> body{load(offset_of_argument(call.argument, false))};
        if (~call.mask) body.push_back(BPF_STMT(BPF_ALU | BPF_AND | BPF_K, call.mask));
        for (const std::uint32_t value : call.values) {
            body.push_back(unless_equal(value, 1));
            body.push_back(ret(kAllow));
        }
        body.push_back(ret(kRefuse));
        code_.push_back(unless_equal(std::uint32_t(call.call), std::uint8_t(body.size())));
        code_.insert(code_.end(), body.begin(), body.end());
    }

    /// prlimit64 of this process, without the pointer to a new limit, which is two words.
    void limit_reading() {
        code_.push_back(unless_equal(SYS_prlimit64, 8));
        add({load(offset_of_argument(0, false)), unless_equal(0, 5), load(offset_of_argument(2, false)),
             unless_equal(0, 3), load(offset_of_argument(2, true)), unless_equal(0, 1), ret(kAllow),
             ret(kRefuse)});
    }

    std::vector<sock_filter> code_;
};

bool has_action(std::uint32_t action) {
    return kArchitecture != 0 && syscall(SYS_seccomp, SECCOMP_GET_ACTION_AVAIL, 0, &action) == 0;
}

}  // namespace

bool has_system_call_filters() {
    return has_action(SECCOMP_RET_ERRNO);
}

bool has_thread_notices() {
    // SECCOMP_USER_NOTIF_FLAG_CONTINUE, without which no thread could start, is younger than the action.
    utsname kernel{};
    int major = 0, minor = 0;
    return has_action(SECCOMP_RET_USER_NOTIF) && uname(&kernel) == 0 &&
           std::sscanf(kernel.release, "%d.%d", &major, &minor) == 2 &&
           (major > 5 || (major == 5 && minor >= 5));
}

int notice_threads() {
    std::array<sock_filter, 4> code{load(offsetof(seccomp_data, nr)), unless_equal(SYS_clone, 1),
                                    ret(SECCOMP_RET_USER_NOTIF), ret(kAllow)};
    const sock_fprog program{code.size(), code.data()};
    if (!has_thread_notices()) return -1;
    return int(syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_NEW_LISTENER, &program));
}

bool filter_system_calls() {
    Filter filter;
    const sock_fprog program = filter.program();
    return has_system_call_filters() && syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, &program) == 0;
}

}  // namespace aftershade
