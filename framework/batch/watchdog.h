// Notices that a worker has said nothing for too long.
#pragma once

#include <atomic>
#include <chrono>
#include <thread>

namespace aftershade {

/// Raises a flag, run_worker's interrupt, when nothing was heard for a while, or when the user asked to stop.
/// [heard() from any thread]
class Watchdog {
public:
    /// Without patience (infinite) only `stop` is passed on.
    Watchdog(std::chrono::duration<double> patience, const std::atomic<bool>& stop);
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    void heard() { heard_ = Clock::now(); }
    bool barked() const { return barked_; }  ///< the worker was silent for too long
    const std::atomic<bool>& flag() const { return flag_; }

private:
    using Clock = std::chrono::steady_clock;
    void watch();

    const std::chrono::duration<double> patience_;
    const std::atomic<bool>& stop_;
    std::atomic<Clock::time_point> heard_;
    std::atomic<bool> done_ = false, barked_ = false, flag_ = false;
    std::thread thread_;  // last: it uses the others
};

}  // namespace aftershade
