#include "cli/interrupt.h"

#include <csignal>
#include <cstdint>
#include <cstring>
#include <ctime>

namespace aftershade::cli {

namespace {

// A signal handler can reach nothing but globals.
std::atomic<bool> interrupted{false};
std::atomic<int> first_number{0};
std::atomic<std::int64_t> first_at_ms{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free);

/// timeout(1) sends its signal to the child and then to the group, and so do programs that pass Ctrl+C on.
constexpr std::int64_t kOneInterrupt_ms = 300;

std::int64_t now_ms() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return std::int64_t(now.tv_sec) * 1000 + now.tv_nsec / 1'000'000;
}

void on_signal(int number) {
    if (!interrupted.exchange(true)) {
        first_number = number;
        first_at_ms = now_ms();
        return;
    }
    if (number == first_number && now_ms() - first_at_ms < kOneInterrupt_ms) return;
    // At once: the signal comes again as this returns.
    std::signal(number, SIG_DFL);
    std::raise(number);
}

}  // namespace

const std::atomic<bool>& watch_for_interrupt() {
    struct sigaction action;
    std::memset(&action, 0, sizeof action);
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;  // no file operation ends early because of the signal
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    return interrupted;
}

}  // namespace aftershade::cli
