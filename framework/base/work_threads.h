// Threads that stay, for work that is shorter than a thread's start.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace aftershade {

/// [one caller at a time]
class WorkThreads {
public:
    /// As many threads, the caller's own among them; where the system starts fewer, those do the work.
    explicit WorkThreads(int threads);
    ~WorkThreads();
    WorkThreads(const WorkThreads&) = delete;
    WorkThreads& operator=(const WorkThreads&) = delete;

    int count() const { return int(threads_.size()) + 1; }
    /// Calls work(i) for each i below `count`, in no order, and returns when all are done. `work` must not
    /// throw.
    void run(int count, const std::function<void(int)>& work);

private:
    void wait_for_work();
    /// The caller holds the lock, which is free while a piece is worked on.
    void work_on(std::unique_lock<std::mutex>& lock);

    std::mutex guard_;
    std::condition_variable begun_, done_;
    const std::function<void(int)>* work_ = nullptr;
    int next_ = 0, count_ = 0, unfinished_ = 0;
    bool ends_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace aftershade
