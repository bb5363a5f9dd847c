// Notices that a worker, or a pass of its, takes too long.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include "framework/base/status.h"

namespace aftershade {

/// How long one pass may take to compile or to draw.
struct PassLimit {
    std::chrono::duration<double> timeout{std::chrono::duration<double>::max()};
    bool of_shipped_effects = false;  ///< besides untrusted ones
};

/// Raises a flag, run_worker's interrupt, when nothing was heard for a while, when a pass takes too long, or
/// when the user asked to stop. [heard() and is_at() from any thread]
class Watchdog {
public:
    using Duration = std::chrono::duration<double>;

    /// Without patience (infinite) and a limit only `stop` is passed on.
    Watchdog(Duration patience, PassLimit pass, const std::atomic<bool>& stop);
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    void heard() { heard_ = Clock::now(); }
    void is_at(const WorkStatus& status);
    bool barked() const { return barked_; }  ///< the worker, or its pass, took too long
    /// The time that it had, once it barked.
    Duration timeout() const { return by_pass_ ? pass_.timeout : patience_; }
    /// The value of barked(); never lowered.
    const std::atomic<bool>& barked_flag() const { return barked_; }
    bool barked_at_pass() const { return by_pass_; }
    /// Where the worker was when it had taken too long: it may have moved before it was killed. Empty before.
    WorkStatus status_at_bark() const;
    const std::atomic<bool>& flag() const { return flag_; }

private:
    using Clock = std::chrono::steady_clock;
    void watch();

    const Duration patience_;
    const PassLimit pass_;
    const std::atomic<bool>& stop_;
    std::atomic<Clock::time_point> heard_;
    std::atomic<Clock::time_point> pass_began_{Clock::time_point::max()};
    std::atomic<bool> done_ = false, barked_ = false, by_pass_ = false, flag_ = false;
    mutable std::mutex mutex_;
    WorkStatus status_, status_at_bark_;  // guarded by mutex_
    std::thread thread_;                  // last: it uses the others
};

}  // namespace aftershade
