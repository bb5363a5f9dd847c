// What native code tries to reach outside of its process, seen from outside, as this user and as another one:
// root is refused what ordinary users are not, and the other way round.
#include <gtest/gtest.h>
#include <linux/futex.h>
#include <mqueue.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/msg.h>
#include <sys/sem.h>
#include <sys/shm.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <thread>

#include "framework/base/child_process.h"
#include "framework/effect/native/confinement.h"
#include "framework/effect/native/thread_limit.h"
#include "tests/cli/command.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kNobody = 65534;

/// By what they are of: a file's name, or a word of tests/plugins/attempts.inc.
using Facts = std::map<std::string, std::string>;

struct Attempt {
    std::string name, fact;
    long result = 0;
    int reason = 0;
    bool changed_itself = false;
    std::string read;
};

std::string text_of(const fs::path& file) {
    std::ifstream in(file);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

std::string lines_with(const std::string& text, const std::string& begin) {
    std::string found;
    for (const std::string& line : lines_of_text(text))
        if (line.starts_with(begin)) found += line + "\n";
    return found;
}

/// A user's process, files and sockets, and the program and the library that try to reach them.
class Outside {
public:
    explicit Outside(bool as_nobody) : as_nobody_(as_nobody) {
        fs::permissions(folder_.path(), fs::perms(0755));
        for (const char* const name : {"bin", "home", "home/empty"}) fs::create_directory(folder_ / name);
        fs::copy(AFTERSHADE_PLUGIN_WORKER, program());
        fs::copy(fs::path(AFTERSHADE_CASES) / "attempts.so", folder_ / "bin/attempts.so");
        for (int i = 0; i < 24; ++i) write_text(home() / ("f" + std::to_string(i)), "mine");
        write_text(home() / "shared", std::string(4096, '\0'));
        listen();
        if (as_nobody)
            for (const fs::path& place : own_files())
                if (lchown(place.c_str(), kNobody, kNobody) != 0) throw std::runtime_error("chown");
        victim_.emplace(as_user({program(), "--victim", home()}), folder_.path(),
                        Environment{{"SECRET", secret()}});
        if (!victim_->wait_for_lines(1)) throw std::runtime_error("the victim does not run");
        const std::string where = victim_->printed();
        std::istringstream(where) >> process_ >> file_ >> std::hex >> address_;
        write_text(home() / "outside", lines_of_text(where).at(0) + " " + std::to_string(tcp_port_) + " " +
                                           std::to_string(udp_port_) + " " + own_name() + "\n");
        shared_.emplace(::open((home() / "shared").c_str(), O_RDWR));
        word_ = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, shared_->get(), 0);
        for (int tries = 0; waiters() != 1 && tries < 50; ++tries) {
        }
    }
    ~Outside() {
        for (const pid_t survivor : survivors()) kill(survivor, SIGKILL);
        shmctl(shmget(getpid(), 0, 0), IPC_RMID, nullptr);
        semctl(semget(getpid(), 0, 0), 0, IPC_RMID);
        msgctl(msgget(getpid(), 0), IPC_RMID, nullptr);
        mq_unlink(("/" + own_name()).c_str());
        fs::remove("/dev/shm/" + own_name());
        munmap(word_, 4096);
    }
    Outside(const Outside&) = delete;
    Outside& operator=(const Outside&) = delete;

    static std::string secret() { return "a secret of process " + std::to_string(getpid()); }
    /// The name of what the attempts make, so that tests that run at the same time do not meet.
    static std::string own_name() { return "as" + std::to_string(getpid()); }

    CommandResult run(const std::string& how) const {
        Environment environment{{"HOME", home().string()}};
        if (how != "confined") environment["ALONE"] = "1";
        return Command(as_user({program(), folder_ / "bin", "attempts", how}), folder_.path(), environment)
            .wait();
    }

    /// The library finds nothing to reach then, and tries what it may have.
    void hide() { fs::remove(home() / "outside"); }

    std::map<std::string, int> limits(const std::string& how) const {
        const CommandResult result = run(how);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        std::map<std::string, int> limits;
        for (const std::string& line : lines_of_text(lines_with(result.out + result.err, "limit|")))
            limits[line.substr(6, line.rfind('|') - 6)] = std::stoi(line.substr(line.rfind('|') + 1));
        return limits;
    }

    Facts facts() {
        const std::string folder = "/proc/" + std::to_string(process_);
        cpu_set_t cpus;
        sched_getaffinity(process_, sizeof cpus, &cpus);
        std::string memory(32, ' ');
        const Descriptor file(::open((folder + "/mem").c_str(), O_RDONLY));
        if (pread(file.get(), memory.data(), memory.size(), off_t(address_)) < 0) memory = "unreadable";
        const std::string status = text_of(folder + "/status");
        const mqd_t queue = mq_open(("/" + own_name()).c_str(), O_RDONLY);
        if (queue >= 0) mq_close(queue);
        Facts facts{{"signals", lines_with(status, "SigPnd") + lines_with(status, "ShdPnd")},
                    {"affinity", std::to_string(CPU_COUNT(&cpus))},
                    {"policy", std::to_string(sched_getscheduler(process_))},
                    {"nice", std::to_string(getpriority(PRIO_PROCESS, id_t(process_)))},
                    {"ioprio", std::to_string(syscall(SYS_ioprio_get, 1, process_))},
                    {"limits", text_of(folder + "/limits")},
                    {"memory", memory},
                    {"oom", text_of(folder + "/oom_score_adj")},
                    {"coredump", text_of(folder + "/coredump_filter")},
                    {"ipc", std::to_string((shmget(getpid(), 0, 0) >= 0) + 2 * (semget(getpid(), 0, 0) >= 0) +
                                           4 * (msgget(getpid(), 0) >= 0))},
                    {"shared memory", std::to_string(fs::exists("/dev/shm/" + own_name()))},
                    {"queue", std::to_string(queue >= 0)},
                    {"survivors", std::to_string(survivors().size())},
                    {"futex", std::to_string(waiters())}};
        for (const auto& [name, socket] : {std::pair{"tcp", tcp_}, {"abstract", abstract_}})
            facts[name] = std::to_string(Descriptor(accept(socket, nullptr, nullptr)).get() >= 0);
        char byte = 0;
        facts["udp"] = std::to_string(recv(udp_, &byte, 1, MSG_DONTWAIT));
        for (const fs::path& place : own_files()) facts[place.filename()] = description(place);
        return facts;
    }

private:
    fs::path home() const { return folder_ / "home"; }
    std::string program() const { return folder_ / "bin/plugin_worker"; }
    std::vector<fs::path> own_files() const {
        std::vector<fs::path> places{home()};
        for (const auto& entry : fs::directory_iterator(home()))
            if (entry.path().filename() != "outside") places.push_back(entry.path());
        return places;
    }
    std::vector<std::string> as_user(std::vector<std::string> words) const {
        if (as_nobody_)
            words.insert(words.begin(),
                         {"/usr/bin/setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"});
        return words;
    }

    static std::string description(const fs::path& place) {
        struct stat status {};
        lstat(place.c_str(), &status);
        std::array<char, 256> marks{};
        const ssize_t size = llistxattr(place.c_str(), marks.data(), marks.size());
        std::ostringstream text;
        text << status.st_mode << ' ' << status.st_size << ' ' << status.st_mtime << ' ' << status.st_uid
             << ' ' << status.st_nlink << ' ' << size << ' '
             << (S_ISREG(status.st_mode) ? text_of(place) : "");
        return text.str();
    }

    static std::vector<pid_t> survivors() {
        std::vector<pid_t> found;
        for (const auto& entry : fs::directory_iterator("/proc"))
            if (text_of(entry.path() / "comm").starts_with(own_name()))
                found.push_back(std::stoi(entry.path().filename()));
        return found;
    }

    /// At the word where one thread of the victim waits again once it is woken.
    long waiters() const {
        const long woken = syscall(SYS_futex, word_, FUTEX_WAKE, 9, nullptr, nullptr, 0);
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        return woken;
    }

    void listen() {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        for (const auto& [number, type, port] :
             {std::tuple{&tcp_, SOCK_STREAM, &tcp_port_}, {&udp_, SOCK_DGRAM, &udp_port_}}) {
            *number = socket(AF_INET, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
            socklen_t size = sizeof address;
            address.sin_port = 0;
            if (bind(*number, reinterpret_cast<sockaddr*>(&address), size) != 0)
                throw std::runtime_error("bind");
            getsockname(*number, reinterpret_cast<sockaddr*>(&address), &size);
            *port = ntohs(address.sin_port);
        }
        sockaddr_un hidden{};
        hidden.sun_family = AF_UNIX;
        own_name().copy(hidden.sun_path + 1, sizeof hidden.sun_path - 1);
        abstract_ = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
        if (bind(abstract_, reinterpret_cast<sockaddr*>(&hidden),
                 socklen_t(offsetof(sockaddr_un, sun_path) + 1 + own_name().size())) != 0 ||
            ::listen(abstract_, 4) != 0 || ::listen(tcp_, 4) != 0)
            throw std::runtime_error("listen");
        for (const int number : {tcp_, udp_, abstract_}) sockets_.emplace_back(number);
    }

    bool as_nobody_;
    TemporaryFolder folder_;
    int tcp_ = -1, udp_ = -1, abstract_ = -1, tcp_port_ = 0, udp_port_ = 0;
    std::vector<Descriptor> sockets_;
    std::optional<Command> victim_;
    pid_t process_ = 0;
    int file_ = 0;
    std::uint64_t address_ = 0;
    std::optional<Descriptor> shared_;
    void* word_ = nullptr;
};

std::vector<Attempt> attempts_in(const std::string& text) {
    std::vector<Attempt> attempts;
    for (const std::string& line : lines_of_text(lines_with(text, "attempt|"))) {
        std::vector<std::string> parts;
        std::istringstream in(line);
        for (std::string part; std::getline(in, part, '|');) parts.push_back(part);
        parts.resize(7);
        attempts.push_back(
            {parts[1], parts[2], std::stol(parts[3]), std::stoi(parts[4]), parts[5] == "1", parts[6]});
    }
    return attempts;
}

/// Those that do something, as the kernel, the victim or the files show.
std::set<std::string> effective(const CommandResult& result, Facts before, Facts after) {
    std::set<std::string> names;
    for (const Attempt& attempt : attempts_in(result.out + result.err)) {
        const bool learns = attempt.read.find(Outside::secret().substr(0, 30)) != std::string::npos;
        if (attempt.result >= 0 || attempt.changed_itself || learns ||
            before[attempt.fact] != after[attempt.fact])
            names.insert(attempt.name);
    }
    return names;
}

class NativeConfinement : public testing::TestWithParam<bool> {
protected:
    void SetUp() override {
        const Confinement offered = offered_confinement();
        if (!offered.seccomp || offered.landlock_abi < 1)
            GTEST_SKIP() << "this kernel does not confine plug-ins: `aftershade doctor`";
        if (!GetParam()) return;
        if (geteuid() != 0) GTEST_SKIP() << "only root can become nobody; the other case runs as a user";
        if (!fs::exists("/usr/bin/setpriv")) GTEST_SKIP() << "no setpriv (Debian package util-linux)";
    }
};

TEST_P(NativeConfinement, LetsNoAttemptReachOutside) {
    Outside outside(GetParam());
    const Facts before = outside.facts();
    const CommandResult result = outside.run("confined");
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(outside.facts(), before);
    EXPECT_EQ(result.err.find(Outside::secret().substr(0, 30)), std::string::npos) << result.err;
    const auto states = lines_of_text(lines_with(result.out, "parent|"));
    ASSERT_EQ(states.size(), 2u) << result.out;
    EXPECT_EQ(states[0], states[1]) << "the parent is another one than before";
    std::set<std::string> refused;
    for (const Attempt& attempt : attempts_in(result.err)) {
        EXPECT_LT(attempt.result, 0) << attempt.name;
        EXPECT_TRUE(attempt.reason == EPERM || attempt.reason == EACCES || attempt.reason == ENOSYS)
            << attempt.name << ": " << std::strerror(attempt.reason);
        EXPECT_FALSE(attempt.changed_itself) << attempt.name;
        if (attempt.result < 0) refused.insert(attempt.name);
    }
    EXPECT_GE(refused.size(), 140u);
    EXPECT_NE(result.err.find("\nall\n"), std::string::npos) << result.err;
}

TEST_P(NativeConfinement, IsWhatTheAttemptsFailOf) {
    Outside outside(GetParam());
    const Facts before = outside.facts();
    const CommandResult result = outside.run("alone");
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::set<std::string> names = effective(result, before, outside.facts());
    EXPECT_GE(names.size(), 60u);
    for (const char* const name :
         {"kill", "process_vm_readv", "sched_setaffinity", "setpriority", "ioprio_set", "prlimit", "shmget",
          "fork", "truncate", "TCP", "memfd_create", "taking over who waits in a shared file",
          "reading /proc/PID/environ"})
        EXPECT_TRUE(names.contains(name)) << name;
    if (std::getenv("AFTERSHADE_LIST_ATTEMPTS"))
        for (const Attempt& attempt : attempts_in(result.out))
            std::printf("%-45s %-10s %s\n", attempt.name.c_str(), attempt.fact.c_str(),
                        names.contains(attempt.name) ? "works" : std::strerror(attempt.reason));
}

TEST_P(NativeConfinement, LimitsThreadsAndMemoryAndLeavesRoomForWork) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "the sanitizer needs all of the address space";
#endif
    // A container's own filter may refuse this one's notices of threads. Only a try shows it, and doctor
    // tries.
    const CommandResult doctor = run_aftershade({"doctor"}, ".");
    if (doctor.out.find("any number of threads") != std::string::npos)
        GTEST_SKIP() << "this kernel does not count threads, as `aftershade doctor` says";
    Outside outside(GetParam());
    outside.hide();
    const auto free = outside.limits("alone"), held = outside.limits("confined");
    const int most = int(most_plugin_threads());
    EXPECT_EQ(held.at("some threads"), 257) << "with the first one";
    EXPECT_EQ(held.at("threads"), most - 1) << "the one that starts them has ended";
    EXPECT_LT(held.at("threads at once"), 2 * most);
    EXPECT_GT(free.at("threads"), 2 * most);
    EXPECT_GE(held.at("malloc"), 700) << "of 1,073 MB";
    EXPECT_LE(held.at("malloc"), 1000);
    EXPECT_EQ(free.at("malloc"), 2000);
    EXPECT_LE(held.at("hidden"), 16);
    EXPECT_GE(free.at("hidden"), 100);
    EXPECT_EQ(held.at("input"), 4) << "the bytes of a file";
}

INSTANTIATE_TEST_SUITE_P(As, NativeConfinement, testing::Bool(),
                         [](const auto& user) { return user.param ? "Nobody" : "ThisUser"; });

}  // namespace
}  // namespace aftershade::test
