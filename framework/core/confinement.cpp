#include "framework/core/confinement.h"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/capability.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <initializer_list>

namespace aftershade {

namespace {

// ---- Landlock: by raw system calls, since Debian 12's headers stop at its second ABI ----

constexpr long kLandlockCreateRuleset = 444, kLandlockRestrictSelf = 446;  // of every processor
constexpr unsigned kLandlockVersion = 1;                                   // LANDLOCK_CREATE_RULESET_VERSION

/// struct landlock_ruleset_attr; older ABIs know the first fields only.
struct LandlockRuleset {
    std::uint64_t handled_files = 0;
    std::uint64_t handled_network = 0;
    std::uint64_t scoped = 0;
};

int landlock_abi() {
    const long abi = syscall(kLandlockCreateRuleset, nullptr, 0, kLandlockVersion);
    return abi > 0 ? int(abi) : 0;
}

/// All rights of this ABI but those to read files and folders; no rule gives any back.
LandlockRuleset nothing_but_reading(int abi) {
    constexpr int kReadFile = 2, kReadFolder = 3;
    const int files = abi >= 5 ? 16 : abi >= 3 ? 15 : abi >= 2 ? 14 : 13;
    LandlockRuleset ruleset;
    ruleset.handled_files = ((1ull << files) - 1) & ~(1ull << kReadFile) & ~(1ull << kReadFolder);
    if (abi >= 4) ruleset.handled_network = 3;  // to bind and to connect TCP
    if (abi >= 6) ruleset.scoped = 3;           // abstract sockets and signals
    return ruleset;
}

bool apply_landlock(int abi) {
    const LandlockRuleset ruleset = nothing_but_reading(abi);
    const std::size_t size = abi >= 6   ? sizeof ruleset
                             : abi >= 4 ? offsetof(LandlockRuleset, scoped)
                                        : offsetof(LandlockRuleset, handled_network);
    const int descriptor = int(syscall(kLandlockCreateRuleset, &ruleset, size, 0));
    if (descriptor < 0) return false;
    const bool done = syscall(kLandlockRestrictSelf, descriptor, 0) == 0;
    close(descriptor);
    return done;
}

/// Of root, who may otherwise look into any process (CAP_PERFMON, CAP_SYS_PTRACE).
bool drop_capabilities() {
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    const std::array<__user_cap_data_struct, 2> none{};
    return syscall(SYS_capset, &header, none.data()) == 0;
}

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
    SYS_fadvise64,
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
    SYS_memfd_create,
    SYS_ftruncate,
    SYS_membarrier,
    SYS_futex,
    SYS_set_robust_list,
    SYS_get_robust_list,
    SYS_rseq,
    SYS_set_tid_address,
    SYS_exit,
    SYS_exit_group,
    SYS_sched_yield,
    SYS_sched_getaffinity,
    SYS_sched_setaffinity,
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

/// A call that is allowed where one of its arguments, seen as 32 bits, is right.
struct Guarded {
    enum class Test { has_none, has_all, is_one_of };
    long call = 0;
    unsigned argument = 0;
    Test test = Test::is_one_of;
    std::vector<std::uint32_t> values;  ///< one mask, or what the argument may be
};

constexpr std::uint32_t kWrites = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND;

std::vector<Guarded> guarded_calls() {
    using Test = Guarded::Test;
    const auto self = std::uint32_t(getpid());
    return {
        {SYS_openat, 2, Test::has_none, {kWrites}},
#if defined(__x86_64__)
            {SYS_open, 1, Test::has_none, {kWrites}},
#endif
            {SYS_clone, 0, Test::has_all, {CLONE_THREAD | CLONE_VM | CLONE_SIGHAND}},
            {SYS_tgkill, 0, Test::is_one_of, {self}}, {SYS_kill, 0, Test::is_one_of, {self}},
            {SYS_ioctl, 1, Test::is_one_of, {TCGETS, FIONREAD, FIOCLEX, FIONCLEX, TIOCGWINSZ}},
            {SYS_fcntl, 1, Test::is_one_of, {F_DUPFD, F_GETFD, F_SETFD, F_GETFL, F_SETFL, F_DUPFD_CLOEXEC}},
            {SYS_prctl, 0, Test::is_one_of, {PR_SET_NAME, PR_GET_NAME, PR_GET_DUMPABLE, PR_GET_PDEATHSIG}},
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
        if (call.test == Guarded::Test::is_one_of) {
            for (const std::uint32_t value : call.values) {
                body.push_back(unless_equal(value, 1));
                body.push_back(ret(kAllow));
            }
        } else {
            const std::uint32_t mask = call.values.front();
            body.push_back(BPF_STMT(BPF_ALU | BPF_AND | BPF_K, mask));
            body.push_back(unless_equal(call.test == Guarded::Test::has_all ? mask : 0, 1));
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

bool has_seccomp() {
    const std::uint32_t action = SECCOMP_RET_ERRNO;
    return kArchitecture != 0 && syscall(SYS_seccomp, SECCOMP_GET_ACTION_AVAIL, 0, &action) == 0;
}

bool apply_seccomp() {
    Filter filter;
    const sock_fprog program = filter.program();
    return syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, &program) == 0;
}

}  // namespace

Confinement offered_confinement() {
    return {landlock_abi(), has_seccomp()};
}

Confinement confine_native_code() {
    Confinement held;
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || !drop_capabilities()) return held;
    const Confinement offered = offered_confinement();
    if (offered.landlock_abi > 0 && apply_landlock(offered.landlock_abi))
        held.landlock_abi = offered.landlock_abi;
    held.seccomp = offered.seccomp && apply_seccomp();
    return held;
}

std::vector<std::string> confinement_gaps(const Confinement& held) {
    const bool no_files = held.landlock_abi < 1 && !held.seccomp;
    std::vector<std::string> gaps;
    if (no_files) gaps.emplace_back("write, rename and remove the user's files");
    if (!held.seccomp) {
        gaps.emplace_back(held.landlock_abi >= 4 ? "open sockets other than TCP" : "open sockets");
        gaps.emplace_back(held.landlock_abi >= 1 ? "start processes, which outlive the run"
                                                 : "start programs, which outlive the run");
        if (held.landlock_abi < 6) gaps.emplace_back("send signals to the user's processes");
    }
    if (held.landlock_abi < 1)
        gaps.emplace_back("read the memory and the environment of the user's other processes");
    return gaps;
}

}  // namespace aftershade
