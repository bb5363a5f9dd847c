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
    const auto api = egl_function<PFNEGLQUERYAPIPROC>("eglQueryAPI");
    if (!context || !display || !surface || !api) return {};
    if (context() == EGL_NO_CONTEXT) return {nullptr, nullptr, nullptr, nullptr, api()};
    return {display(), surface(EGL_DRAW), surface(EGL_READ), context(), api()};
}

void release_egl_context(const EglCurrent& found) noexcept {
    make_egl_current(found.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

void restore_egl_context(const EglCurrent& found) noexcept {
    if (found.context) make_egl_current(found.display, found.draw, found.read, found.context);
    const auto bind_api = egl_function<PFNEGLBINDAPIPROC>("eglBindAPI");
    if (bind_api && found.api != 0) bind_api(found.api);
}

}  // namespace aftershade::gpu
