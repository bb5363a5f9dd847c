// Denormal floats as shaders treat them. Internal to framework/gpu.
#pragma once

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace aftershade::gpu {

/// While this lives, denormal floats count as zero in this thread, and in the threads that it starts for as
/// long as they live. llvmpipe sets that in the threads that run fragment shaders, but not in those that run
/// compute shaders: without this, a pass would have other bits as compute.
class FlushedDenormals {
public:
#ifdef __SSE2__
    FlushedDenormals() : before_(_mm_getcsr()) {
        _mm_setcsr(before_ | kFlushToZero | kDenormalsAreZero);
    }
    ~FlushedDenormals() {
        _mm_setcsr(before_);
    }
#else
    FlushedDenormals() {}  // llvmpipe sets it on x86 alone
    ~FlushedDenormals() {}
#endif
    FlushedDenormals(const FlushedDenormals&) = delete;
    FlushedDenormals& operator=(const FlushedDenormals&) = delete;

private:
#ifdef __SSE2__
    static constexpr unsigned int kFlushToZero = 0x8000, kDenormalsAreZero = 0x40;  ///< of MXCSR
    unsigned int before_ = 0;
#endif
};

}  // namespace aftershade::gpu
