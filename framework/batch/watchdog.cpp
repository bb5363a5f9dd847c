#include "framework/batch/watchdog.h"

namespace aftershade {

Watchdog::Watchdog(Duration patience, PassLimit pass, const std::atomic<bool>& stop)
    : patience_(patience), pass_(pass), stop_(stop), heard_(Clock::now()), thread_([this] { watch(); }) {}

Watchdog::~Watchdog() {
    done_ = true;
    thread_.join();
}

void Watchdog::is_at(const WorkStatus& status) {
    const bool is_limited = !status.pass.empty() && (status.is_foreign || pass_.of_shipped_effects);
    pass_began_ = is_limited ? Clock::now() : Clock::time_point::max();
    const std::scoped_lock lock(mutex_);
    status_ = status;
}

WorkStatus Watchdog::status_at_bark() const {
    const std::scoped_lock lock(mutex_);
    return status_at_bark_;
}

void Watchdog::watch() {
    while (!done_) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        if (stop_) flag_ = true;
        const auto now = Clock::now(), pass_began = pass_began_.load();
        by_pass_ = pass_began <= now && now - pass_began > pass_.timeout;
        if (!flag_ && (by_pass_ || now - heard_.load() > patience_)) {
            {
                const std::scoped_lock lock(mutex_);
                status_at_bark_ = status_;
            }
            barked_ = true;
            flag_ = true;
            return;
        }
    }
}

}  // namespace aftershade
