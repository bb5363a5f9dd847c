#include "framework/batch/watchdog.h"

namespace aftershade {

Watchdog::Watchdog(std::chrono::duration<double> patience, const std::atomic<bool>& stop)
    : patience_(patience), stop_(stop), heard_(Clock::now()), thread_([this] { watch(); }) {}

Watchdog::~Watchdog() {
    done_ = true;
    thread_.join();
}

void Watchdog::watch() {
    while (!done_) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        if (stop_) flag_ = true;
        if (!flag_ && Clock::now() - heard_.load() > patience_) {
            barked_ = true;
            flag_ = true;
        }
    }
}

}  // namespace aftershade
