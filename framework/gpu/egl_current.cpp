#include "framework/gpu/egl_current.h"

#include <dlfcn.h>
#include <glad/egl.h>

namespace aftershade::gpu {
namespace {

/// nullptr where the process has no EGL.
template <typename Function>
Function egl_function(const char* name) noexcept {
    // Counts one more use of a library that the process keeps for ever anyway.
    void* const library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_NOLOAD);
    return library ? reinterpret_cast<Function>(dlsym(library, name)) : nullptr;
}

bool make_egl_current(void* display, void* draw, void* read, void* context) noexcept {
    const auto function = egl_function<PFNEGLMAKECURRENTPROC>("eglMakeCurrent");
    return function && function(display, draw, read, context);
}

}  // namespace

EglCurrent current_egl_context() noexcept {
    const auto context = egl_function<PFNEGLGETCURRENTCONTEXTPROC>("eglGetCurrentContext");
    const auto display = egl_function<PFNEGLGETCURRENTDISPLAYPROC>("eglGetCurrentDisplay");
    const auto surface = egl_function<PFNEGLGETCURRENTSURFACEPROC>("eglGetCurrentSurface");
    if (!context || !display || !surface || context() == EGL_NO_CONTEXT) return {};
    return {display(), surface(EGL_DRAW), surface(EGL_READ), context()};
}

void release_egl_context(const EglCurrent& current) noexcept {
    make_egl_current(current.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

void restore_egl_context(const EglCurrent& found) noexcept {
    make_egl_current(found.display, found.draw, found.read, found.context);
}

}  // namespace aftershade::gpu
