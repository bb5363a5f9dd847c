// The rows or values of a picture on all cores.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace aftershade {

/// The number of threads that 0, "as many as there are cores", stands for.
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

/// Calls work(i) for each index below `count`, many at once on one thread, in no order.
template <class Work>
void for_each_index(std::size_t count, int threads, const Work& work) {
    constexpr std::size_t kAtOnce = 256;
    for_each_row(int((count + kAtOnce - 1) / kAtOnce), threads, [&](int part) {
        const std::size_t first = std::size_t(part) * kAtOnce;
        for (std::size_t i = first; i < std::min(first + kAtOnce, count); ++i) work(i);
    });
}

/// Values from `begin` to before `end`.
struct Part {
    std::size_t begin = 0;
    std::size_t end = 0;
};

/// `count` values in parts that follow each other, one for each thread, or a single one where they are too
/// few to be worth a thread. Each begins at a multiple of `step`.
inline std::vector<Part> parts_for_threads(std::size_t count, std::size_t step, int threads) {
    // The amount that a core decodes in the time of a thread's start.
    constexpr std::size_t kWorthwhile = 262'144;
    const std::size_t most = std::max<std::size_t>(1, std::min(std::size_t(threads), count / kWorthwhile));
    const std::size_t steps = (count + step - 1) / step;
    std::vector<Part> parts;
    for (std::size_t i = 0; i < most; ++i)
        parts.push_back({steps * i / most * step, std::min(count, steps * (i + 1) / most * step)});
    return parts;
}

/// The results of work(part) for all parts, in their order.
template <class Work>
auto for_each_part(const std::vector<Part>& parts, const Work& work) {
    std::vector<decltype(work(Part()))> results(parts.size());
    for_each_row(int(parts.size()), int(parts.size()),
                 [&](int i) { results[std::size_t(i)] = work(parts[std::size_t(i)]); });
    return results;
}

}  // namespace aftershade
