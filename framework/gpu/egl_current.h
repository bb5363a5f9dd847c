// What EGL has current in a thread, whoever made it so. ForeignContextGuard is for programs that have
// contexts of their own; the rest is internal to framework/gpu.
#pragma once

namespace aftershade::gpu {

/// Pointers are null where nothing is current.
struct EglCurrent {
    void* display = nullptr;
    void* draw = nullptr;
    void* read = nullptr;
    void* context = nullptr;
    unsigned int api = 0;  ///< that the thread's calls of EGL mean: eglBindAPI; 0 without EGL
};

/// Does not load EGL where the process has not.
EglCurrent current_egl_context() noexcept;
void release_egl_context(const EglCurrent& found) noexcept;
/// The context, where there was one, and the API.
void restore_egl_context(const EglCurrent& found) noexcept;

/// Stands around calls of a library that makes contexts current. What EGL had current in this thread, beside
/// our own contexts, is current again when this goes; where nothing was, our context stays. Also notices
/// where the program has put another context in the place of ours. [one thread; nests]
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
