// What EGL has current in a thread, whoever made it so. Internal to framework/gpu.
#pragma once

namespace aftershade::gpu {

/// Null throughout where nothing is current.
struct EglCurrent {
    void* display = nullptr;
    void* draw = nullptr;
    void* read = nullptr;
    void* context = nullptr;
};

/// Does not load EGL where the process has not.
EglCurrent current_egl_context() noexcept;
void release_egl_context(const EglCurrent& current) noexcept;
void restore_egl_context(const EglCurrent& found) noexcept;

}  // namespace aftershade::gpu
