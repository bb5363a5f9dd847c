#include "framework/effect/native/confinement.h"

#include <dirent.h>
#include <fcntl.h>
#include <linux/capability.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstddef>
#include <string_view>

#include "framework/base/child_process.h"
#include "framework/effect/native/system_call_filter.h"
#include "framework/effect/native/thread_limit.h"

namespace aftershade {

namespace {

// ---- Landlock: by raw system calls, since Debian 12's headers stop at its second ABI ----

constexpr long kLandlockCreateRuleset = 444, kLandlockAddRule = 445, kLandlockRestrictSelf = 446;
constexpr unsigned kLandlockVersion = 1;       // LANDLOCK_CREATE_RULESET_VERSION
constexpr int kLandlockPathBeneath = 1;        // LANDLOCK_RULE_PATH_BENEATH
constexpr int kReadFile = 2, kReadFolder = 3;  // bits of the rights

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

/// All rights of this ABI but the one to read folders.
LandlockRuleset all_but_listing(int abi) {
    const int files = abi >= 5 ? 16 : abi >= 3 ? 15 : abi >= 2 ? 14 : 13;
    LandlockRuleset ruleset;
    ruleset.handled_files = ((1ull << files) - 1) & ~(1ull << kReadFolder);
    if (abi >= 4) ruleset.handled_network = 3;  // to bind and to connect TCP
    if (abi >= 6) ruleset.scoped = 3;           // abstract sockets and signals
    return ruleset;
}

/// struct landlock_path_beneath_attr.
struct [[gnu::packed]] LandlockPath {
    std::uint64_t allowed = 0;
    int descriptor = -1;
};

bool allow_reading(int ruleset, const std::string& path) {
    const Descriptor place(open(path.c_str(), O_PATH | O_NOFOLLOW | O_CLOEXEC));
    struct stat status {};
    if (place.get() < 0 || fstat(place.get(), &status) != 0) return false;
    if (S_ISLNK(status.st_mode)) return true;  // what it leads to has a rule of its own
    const LandlockPath rule{1ull << kReadFile, place.get()};
    return syscall(kLandlockAddRule, ruleset, kLandlockPathBeneath, &rule, 0) == 0;
}

/// Whoever reads a terminal takes the keys that another program waits for, and opening some devices makes
/// them act. A mount that cannot be examined gets no rule.
bool allow_reading_all_but_devices(int ruleset) {
    DIR* const root = opendir("/");
    if (!root) return false;
    while (const dirent* entry = readdir(root)) {
        const std::string_view name = entry->d_name;
        if (name != "." && name != ".." && name != "dev") allow_reading(ruleset, "/" + std::string(name));
    }
    closedir(root);
    for (const char* const device : {"null", "zero", "full", "random", "urandom"})
        allow_reading(ruleset, std::string("/dev/") + device);
    return true;
}

bool apply_landlock(int abi) {
    const LandlockRuleset ruleset = all_but_listing(abi);
    const std::size_t size = abi >= 6   ? sizeof ruleset
                             : abi >= 4 ? offsetof(LandlockRuleset, scoped)
                                        : offsetof(LandlockRuleset, handled_network);
    const Descriptor descriptor(int(syscall(kLandlockCreateRuleset, &ruleset, size, 0)));
    return descriptor.get() >= 0 && allow_reading_all_but_devices(descriptor.get()) &&
           syscall(kLandlockRestrictSelf, descriptor.get(), 0) == 0;
}

/// Of root, who may otherwise look into any process (CAP_PERFMON, CAP_SYS_PTRACE).
bool drop_capabilities() {
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    const std::array<__user_cap_data_struct, 2> none{};
    return syscall(SYS_capset, &header, none.data()) == 0;
}

void lower_limit(__rlimit_resource_t resource, rlim_t most) {
    rlimit now{};
    if (getrlimit(resource, &now) != 0) return;
    now.rlim_max = std::min(now.rlim_max, most);
    now.rlim_cur = std::min(now.rlim_cur, now.rlim_max);
    setrlimit(resource, &now);
}

/// What the kernel keeps for a process outside of its address space: files in memory, even where they can be
/// made, pipes and timers.
void limit_resources() {
    std::signal(SIGXFSZ, SIG_IGN);  // a write then fails with EFBIG
    lower_limit(RLIMIT_FSIZE, 0);
    lower_limit(RLIMIT_NOFILE, kMostPluginFiles);
    lower_limit(RLIMIT_SIGPENDING, 1024);
    lower_limit(RLIMIT_MSGQUEUE, 0);
}

std::uint64_t address_space_bytes() {
    rlimit now{};
    return getrlimit(RLIMIT_AS, &now) == 0 && now.rlim_cur != RLIM_INFINITY ? now.rlim_cur : 0;
}

}  // namespace

Confinement offered_confinement() {
    return {landlock_abi(), has_system_call_filters(), has_thread_notices(), address_space_bytes()};
}

Confinement confine_native_code(int stream) {
    Confinement held;
    limit_resources();
    held.memory_bytes = address_space_bytes();
    const bool can_confine = prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && drop_capabilities();
    // Closed before any library is there: it could answer for its own threads.
    const Descriptor notices(can_confine ? notice_threads() : -1);
    held.counts_threads = send_thread_notices(stream, notices.get()) && notices.get() >= 0;
    if (!can_confine) return held;
    const int abi = landlock_abi();
    if (abi > 0 && apply_landlock(abi)) held.landlock_abi = abi;
    held.seccomp = filter_system_calls();
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
        gaps.emplace_back("change the priority and the processors of the user's processes");
    }
    if (!held.counts_threads) gaps.emplace_back("start any number of threads");
    if (held.landlock_abi < 1) {
        gaps.emplace_back("read devices, the terminal's keys among them");
        gaps.emplace_back("read the memory and the environment of the user's other processes");
    }
    return gaps;
}

}  // namespace aftershade
