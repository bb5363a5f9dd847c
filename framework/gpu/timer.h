// How long a pass took.
#pragma once

#include <chrono>
#include <memory>

#include "framework/gpu/context.h"

namespace aftershade::gpu {

/// Milliseconds between start() and stop(). On software drivers it is wall time around glFinish, because
/// GL_TIME_ELAPSED lies on llvmpipe; on hardware it is a pair of GL_TIMESTAMP queries.
/// [the context's thread]
class Timer {
public:
    explicit Timer(Context& context);
    ~Timer();
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

    void start();
    double stop_ms();  ///< waits for the GPU
    /// "wall" or "gpu", for labels.
    static const char* clock_name(const Context& context);

private:
    Context& context_;
    std::chrono::steady_clock::time_point start_;
    unsigned int queries_[2] = {0, 0};
};

}  // namespace aftershade::gpu
