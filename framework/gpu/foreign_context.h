// For programs that have GL contexts of their own: leaves a thread's current EGL context as it was found.
#pragma once

#include "framework/gpu/egl_current.h"

namespace aftershade::gpu {

/// Stands around calls of a library that makes contexts current. What EGL had current in this thread, beside
/// our own contexts, is current again when this goes; where nothing was, our context stays. Also notices where
/// the program has put another context in the place of ours. [one thread; nests]
class ForeignContextGuard {
public:
    ForeignContextGuard();
    ~ForeignContextGuard();
    ForeignContextGuard(const ForeignContextGuard&) = delete;
    ForeignContextGuard& operator=(const ForeignContextGuard&) = delete;

private:
    EglCurrent found_;
};

}  // namespace aftershade::gpu
