// The rows of a picture on all cores.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace aftershade {

/// What 0, "as many as there are cores", stands for.
inline int thread_count(int asked) {
    return asked > 0 ? asked : std::max(1, int(std::thread::hardware_concurrency()));
}

/// Calls work(row) for each row, on `threads` threads, in no order; rows must not depend on each other. Where
/// the system starts fewer threads, those do the work. Rethrows the first exception.
template <class Work>
void for_each_row(int rows, int threads, const Work& work) {
    std::atomic<int> next = 0;
    std::exception_ptr failure;
    std::mutex guard;
    const auto run = [&] {
        try {
            for (int row = next++; row < rows; row = next++) work(row);
        } catch (...) {
            const std::lock_guard lock(guard);
            if (!failure) failure = std::current_exception();
        }
    };
    std::vector<std::jthread> others;
    try {
        for (int i = 1; i < threads; ++i) others.emplace_back(run);
    } catch (const std::system_error&) {  // no memory for a stack, or too many threads
    }
    run();
    others.clear();
    if (failure) std::rethrow_exception(failure);
}

}  // namespace aftershade
