#include "framework/base/work_threads.h"

#include <system_error>

namespace aftershade {

WorkThreads::WorkThreads(int threads) {
    try {
        for (int i = 1; i < threads; ++i) threads_.emplace_back([this] { wait_for_work(); });
    } catch (const std::system_error&) {  // no memory for a stack, or too many threads
    }
}

WorkThreads::~WorkThreads() {
    {
        const std::lock_guard lock(guard_);
        ends_ = true;
    }
    begun_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

void WorkThreads::run(int count, const std::function<void(int)>& work) {
    if (count == 1 || threads_.empty()) {
        for (int i = 0; i < count; ++i) work(i);
        return;
    }
    std::unique_lock lock(guard_);
    work_ = &work;
    next_ = 0;
    count_ = unfinished_ = count;
    lock.unlock();
    begun_.notify_all();
    lock.lock();
    work_on(lock);
    done_.wait(lock, [this] { return unfinished_ == 0; });
    work_ = nullptr;
}

void WorkThreads::wait_for_work() {
    std::unique_lock lock(guard_);
    while (true) {
        begun_.wait(lock, [this] { return ends_ || next_ < count_; });
        if (ends_) return;
        work_on(lock);
    }
}

void WorkThreads::work_on(std::unique_lock<std::mutex>& lock) {
    while (next_ < count_) {
        const int mine = next_++;
        const auto& work = *work_;
        lock.unlock();
        work(mine);
        lock.lock();
        if (--unfinished_ == 0) done_.notify_one();
    }
}

}  // namespace aftershade
