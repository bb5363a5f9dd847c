#include "framework/base/memory_limit.h"

#include <fcntl.h>
#include <malloc.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>

#include "framework/base/error.h"
#include "framework/base/option.h"

namespace aftershade {

namespace {

constexpr std::uint64_t kMiB = 1024 * 1024;
std::string remedy_text() {
    return "raise the limit (ulimit -v, ulimit -d), free memory, or run less at once (" +
           spelled(Option::scale, "1/2") + advice(", ", Option::region, "", "") +
           advice(", ", Option::read_ahead, "1", "") + ")";
}
/// What a handler of signals needs, which must not allocate.
struct LastWords {
    int exit_code = 0;
    std::string remedy;
};
const LastWords* g_last_words = nullptr;
/// A crash with less than this left is put down to memory: a thread's stack takes 8 MiB, and what Mesa asks
/// for at once seldom more than this.
constexpr std::uint64_t kNearLimit = 64 * kMiB;

/// The pages of a process: all of its address space, those in memory, and its data with its stacks (proc(5),
/// statm).
struct Pages {
    std::uint64_t taken = 0, resident = 0, data = 0;
};

/// Safe in a signal handler. Zeros where the file is not there.
Pages pages_of(const char* statm) {
    std::array<char, 64> text{};
    const int file = open(statm, O_RDONLY | O_CLOEXEC);
    if (file < 0) return {};
    const ssize_t count = read(file, text.data(), text.size() - 1);
    close(file);
    std::array<std::uint64_t, 6> columns{};
    const char* const end = text.data() + (count > 0 ? count : 0);
    const char* at = text.data();
    for (std::uint64_t& column : columns)
        if (at < end) at = std::from_chars(at, end, column).ptr + 1;
    return {columns[0], columns[1], columns[5]};
}

std::uint64_t page_bytes() {
    return std::uint64_t(sysconf(_SC_PAGESIZE));
}

struct Room {
    std::uint64_t limit = 0, left = 0;
    const char* of = "";
};

/// The tighter of the limits of the address space and of data: what the program asks for counts in both.
/// Safe in a signal handler.
std::optional<Room> room_left() {
    std::optional<Room> least;
    rlimit limit{};
    const auto look = [&](std::uint64_t pages, const char* of) {
        const std::uint64_t taken = pages * page_bytes();
        const Room room{limit.rlim_cur, limit.rlim_cur > taken ? limit.rlim_cur - taken : 0, of};
        if (!least || room.left < least->left) least = room;
    };
    const auto is_limited = [&](auto resource) {
        return getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
    };
    const Pages pages = pages_of("/proc/self/statm");
    if (is_limited(RLIMIT_AS)) look(pages.taken, "address space");
    if (is_limited(RLIMIT_DATA)) look(pages.data, "data");
    return least;
}

/// Safe in a signal handler, so without fmt and without a buffer of stdio.
[[noreturn]] void end_for_memory(std::string_view what) {
    for (const std::string_view part :
         {std::string_view("aftershade: error: out of memory ("), what, std::string_view("): "),
          std::string_view(g_last_words->remedy), std::string_view("\n")})
        if (write(STDERR_FILENO, part.data(), part.size()) < 0) break;
    _exit(g_last_words->exit_code);
}

void on_crash(int signal_number) {
    if (const auto left = address_space_left(); left && *left < kNearLimit)
        end_for_memory("a library crashed where the limit of memory is reached");
    // Back in the faulting code the signal comes again, with its default action (SA_RESETHAND).
    raise(signal_number);
}

[[noreturn]] void on_terminate() {
    if (const std::exception_ptr thrown = std::current_exception()) {
        try {
            std::rethrow_exception(thrown);
        } catch (const std::exception& error) {
            if (is_out_of_memory(error)) end_for_memory("in a thread");
        } catch (...) {
        }
    }
    std::abort();
}

/// Measured with Mesa 22.3.6: a frame of 480 x 270 takes 380 MB with two threads and 650 MB with 16, stacks
/// and what each thread's tiles take.
void limit_llvmpipe(std::uint64_t limit) {
    constexpr std::uint64_t kWithOneThread = 380 * kMiB, kThread = 20 * kMiB;
    const std::uint64_t threads = 1 + (std::max(limit, kWithOneThread) - kWithOneThread) / kThread;
    if (threads < std::thread::hardware_concurrency())
        setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 0);
}

/// The stack of a crash handler, since a crash may be a stack that could not grow.
void watch_crashes() {
    constexpr std::size_t kStackBytes = 64 * 1024;
    alignas(16) static std::array<std::byte, kStackBytes> memory;
    stack_t stack{};
    stack.ss_sp = memory.data();
    stack.ss_size = memory.size();
    sigaltstack(&stack, nullptr);
    struct sigaction action;
    std::memset(&action, 0, sizeof action);
    action.sa_handler = on_crash;
    action.sa_flags = int(SA_RESETHAND | SA_NODEFER | SA_ONSTACK);
    for (const int signal_number : {SIGSEGV, SIGBUS, SIGABRT, SIGILL})
        sigaction(signal_number, &action, nullptr);
}

}  // namespace

bool is_out_of_memory(const std::exception& error) {
    if (dynamic_cast<const std::bad_alloc*>(&error) || dynamic_cast<const std::length_error*>(&error))
        return true;
    if (const auto* own = dynamic_cast<const Error*>(&error)) return own->kind() == ErrorKind::memory;
    const auto* system = dynamic_cast<const std::system_error*>(&error);
    return system && (system->code() == std::errc::resource_unavailable_try_again ||
                      system->code() == std::errc::not_enough_memory);
}

std::string out_of_memory_text(const std::exception& error) {
    if (dynamic_cast<const Error*>(&error)) return error.what();
    const bool is_thread = dynamic_cast<const std::system_error*>(&error) != nullptr;
    return "out of memory (" +
           (is_thread ? "no thread could be started: " + std::string(error.what())
                      : std::string("the system refused an allocation")) +
           "): " + remedy_text() + (is_thread ? ", or the limit of processes (ulimit -u)" : "");
}

std::optional<std::uint64_t> address_space_left() {
    const auto room = room_left();
    return room ? std::optional(room->left) : std::nullopt;
}

std::uint64_t resident_bytes(int process) {
    return pages_of(("/proc/" + std::to_string(process) + "/statm").c_str()).resident * page_bytes();
}

std::uint64_t machine_memory_bytes() {
    std::uint64_t bytes = std::uint64_t(sysconf(_SC_PHYS_PAGES)) * page_bytes();
    std::uint64_t of_group = 0;
    // "max" where the control group has no limit of its own.
    if (std::ifstream group("/sys/fs/cgroup/memory.max"); group >> of_group)
        bytes = std::min(bytes, of_group);
    return bytes;
}

void require_address_space(std::uint64_t bytes, const std::string& what) {
    const auto room = room_left();
    if (!room || room->left >= bytes) return;
    throw Error(ErrorKind::memory, "out of memory: " + what + " needs " + std::to_string(bytes / kMiB) +
                                       " MiB of " + room->of + ", and the limit of " +
                                       std::to_string(room->limit / kMiB) + " MiB leaves " +
                                       std::to_string(room->left / kMiB) + " MiB: " + remedy_text());
}

void share_one_heap() {
    mallopt(M_ARENA_MAX, 1);
}

void prepare_for_memory_limit(int exit_code) {
    static const LastWords last_words{exit_code, remedy_text()};
    g_last_words = &last_words;
    std::set_terminate(on_terminate);
    const auto room = room_left();
    if (!room) return;
    share_one_heap();
    limit_llvmpipe(room->limit);
    watch_crashes();
}

}  // namespace aftershade
