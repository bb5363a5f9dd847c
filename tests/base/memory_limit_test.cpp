#include "framework/base/memory_limit.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <functional>
#include <new>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "framework/base/error.h"

namespace aftershade {
namespace {

TEST(OutOfMemory, IsKnownByItsExceptions) {
    EXPECT_TRUE(is_out_of_memory(std::bad_alloc()));
    EXPECT_TRUE(is_out_of_memory(std::bad_array_new_length()));
    EXPECT_TRUE(is_out_of_memory(std::length_error("vector::reserve")));
    EXPECT_TRUE(
        is_out_of_memory(std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again))));
    EXPECT_TRUE(is_out_of_memory(std::system_error(std::make_error_code(std::errc::not_enough_memory))));
    EXPECT_TRUE(is_out_of_memory(Error(ErrorKind::memory, "")));
    EXPECT_FALSE(is_out_of_memory(Error(ErrorKind::output, "")));
    EXPECT_FALSE(is_out_of_memory(std::system_error(std::make_error_code(std::errc::io_error))));
    EXPECT_FALSE(is_out_of_memory(std::runtime_error("")));
}

constexpr int kMemoryCode = 7;

/// The exit code of a child that may take `limit_bytes` of address space; 128 + signal after a signal.
int end_of_child(rlim_t limit_bytes, const std::function<void()>& work) {
    const pid_t child = fork();
    if (child == 0) {
        const rlimit limit{limit_bytes, limit_bytes}, no_core{0, 0};
        setrlimit(RLIMIT_CORE, &no_core);
        setrlimit(RLIMIT_AS, &limit);
        prepare_for_memory_limit(kMemoryCode);
        try {
            work();
        } catch (const Error& error) {
            _exit(error.kind() == ErrorKind::memory ? kMemoryCode : 1);
        }
        _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

constexpr rlim_t kMiB = 1024 * 1024;

/// How many threads llvmpipe is held to under a limit; 0: to none.
int llvmpipe_threads(rlim_t limit_bytes) {
    return end_of_child(limit_bytes, [] {
        const char* threads = std::getenv("LP_NUM_THREADS");
        _exit(threads ? std::atoi(threads) : 0);
    });
}

TEST(AddressSpace, ThatIsShortGetsLlvmpipeFewerThreads) {
    if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "one core has one thread";
    unsetenv("LP_NUM_THREADS");
    EXPECT_EQ(llvmpipe_threads(RLIM_INFINITY), 0);
    EXPECT_EQ(llvmpipe_threads(300 * kMiB), 1);
    EXPECT_EQ(llvmpipe_threads(16'000 * kMiB), 0);
    setenv("LP_NUM_THREADS", "7", 1);
    EXPECT_EQ(llvmpipe_threads(300 * kMiB), 7) << "the user's word counts";
    unsetenv("LP_NUM_THREADS");
}

TEST(AddressSpace, IsRequiredBeforeItRunsOut) {
    EXPECT_EQ(end_of_child(400 * kMiB, [] { require_address_space(100 * kMiB, "a test"); }), 0);
    EXPECT_EQ(end_of_child(400 * kMiB, [] { require_address_space(500 * kMiB, "a test"); }), kMemoryCode);
    EXPECT_EQ(end_of_child(RLIM_INFINITY, [] { require_address_space(1ull << 50, "a test"); }), 0);
}

TEST(Crash, IsPutDownToMemoryOnlyWhereTheLimitIsReached) {
    const auto crash = [] { std::raise(SIGSEGV); };
    EXPECT_EQ(end_of_child(4096 * kMiB, crash), 128 + SIGSEGV) << "a fault of another kind stays a crash";
    EXPECT_EQ(end_of_child(400 * kMiB,
                           [&] {
                               const std::uint64_t left = address_space_left().value_or(0);
                               // Asked for in pieces: half of what is left, until little is.
                               for (std::uint64_t bytes = left / 2; bytes > kMiB; bytes /= 2) {
                                   // Volatile, or the compiler may leave the allocation out.
                                   [[maybe_unused]] const volatile char* kept =
                                       static_cast<volatile char*>(operator new(bytes, std::nothrow));
                               }
                               crash();
                           }),
              kMemoryCode);
}

TEST(Thread, ThatRunsOutOfMemoryEndsTheProcessWithThatExit) {
    EXPECT_EQ(end_of_child(RLIM_INFINITY, [] { std::thread([] { throw std::bad_alloc(); }).join(); }),
              kMemoryCode);
    EXPECT_EQ(end_of_child(RLIM_INFINITY, [] { std::thread([] { throw 1; }).join(); }), 128 + SIGABRT);
}

}  // namespace
}  // namespace aftershade
