// How long a pass took.
#pragma once

#include <array>
#include <chrono>
#include <memory>

#include "framework/gpu/context.h"

namespace aftershade::gpu {

/// A time that the GPU may still be measuring. [the context's thread, within the context's life]
class Duration {
public:
    /// One that is known.
    explicit Duration(double milliseconds) : ms_(milliseconds) {}
    Duration(Context& context, std::array<unsigned int, 2> queries) : context_(&context), queries_(queries) {}
    ~Duration() { give_back(); }
    Duration(Duration&& other) noexcept;
    Duration& operator=(Duration&& other) noexcept;
    Duration(const Duration&) = delete;
    Duration& operator=(const Duration&) = delete;

    double ms();  ///< waits for the GPU

private:
    void give_back() noexcept;

    Context* context_ = nullptr;  // where it is still being measured
    std::array<unsigned int, 2> queries_{};
    double ms_ = 0;
};

/// Milliseconds between start() and stop(). On software drivers it is wall time around glFinish, because
/// GL_TIME_ELAPSED lies on llvmpipe; on hardware it is a pair of GL_TIMESTAMP queries.
/// [the context's thread]
class Timer {
public:
    explicit Timer(Context& context) : context_(context) {}
    ~Timer();
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

    void start();
    Duration stop();                          ///< waits on software drivers alone
    double stop_ms() { return stop().ms(); }  ///< waits for the GPU
    /// "wall" or "gpu", for labels.
    static const char* clock_name(const Context& context);

private:
    Context& context_;
    std::chrono::steady_clock::time_point start_;
    unsigned int begun_ = 0;  // a query
};

}  // namespace aftershade::gpu
