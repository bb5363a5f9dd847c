// An EGL context as a program that embeds the library has it, made without the library's code.
#pragma once

#include <dlfcn.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <glad/egl.h>
#include <glad/gl.h>

namespace aftershade::test {

/// On llvmpipe, without a surface; current once it is made. [one thread]
class OwnEgl {
public:
    OwnEgl() {
        load("eglGetProcAddress", get_proc_);
        load("eglGetPlatformDisplay", get_display_);
        load("eglInitialize", initialize_);
        load("eglBindAPI", bind_api_);
        load("eglCreateContext", create_context_);
        load("eglDestroyContext", destroy_context_);
        load("eglMakeCurrent", make_current_);
        load("eglGetCurrentContext", get_current_);
        display = get_display_(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
        require(initialize_(display, nullptr, nullptr) && bind_api_(EGL_OPENGL_API), "eglInitialize");
        const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
        context = create_context_(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
        require(context != EGL_NO_CONTEXT, "eglCreateContext");
        make_current();
        const auto proc = [](void* user, const char* name) {
            return reinterpret_cast<GLADapiproc>(static_cast<OwnEgl*>(user)->get_proc_(name));
        };
        require(gladLoadGLContextUserPtr(&gl, proc, this) != 0, "GL");
    }
    ~OwnEgl() {
        make_current_(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        destroy_context_(display, context);
    }
    OwnEgl(const OwnEgl&) = delete;
    OwnEgl& operator=(const OwnEgl&) = delete;

    void make_current() {
        require(make_current_(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context), "eglMakeCurrent");
    }
    bool is_current() const { return get_current_() == context; }

    GLuint texture(GLenum format, int width, int height) const {
        GLuint name = 0;
        gl.CreateTextures(GL_TEXTURE_2D, 1, &name);
        gl.TextureStorage2D(name, 1, format, width, height);
        return name;
    }
    std::vector<float> read(GLuint name, GLenum layout, std::size_t count) const {
        std::vector<float> values(count);
        gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
        gl.GetTextureImage(name, 0, layout, GL_FLOAT, GLsizei(count * sizeof(float)), values.data());
        return values;
    }

    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    GladGLContext gl{};

private:
    template <typename Function>
    void load(const char* name, Function& function) {
        static void* const library = dlopen("libEGL.so.1", RTLD_NOW);
        function = library ? reinterpret_cast<Function>(dlsym(library, name)) : nullptr;
        require(function != nullptr, name);
    }
    static void require(bool holds, const std::string& what) {
        if (!holds) throw std::runtime_error("the test's own EGL: " + what + " failed");
    }

    PFNEGLGETPROCADDRESSPROC get_proc_;
    PFNEGLGETPLATFORMDISPLAYPROC get_display_;
    PFNEGLINITIALIZEPROC initialize_;
    PFNEGLBINDAPIPROC bind_api_;
    PFNEGLCREATECONTEXTPROC create_context_;
    PFNEGLDESTROYCONTEXTPROC destroy_context_;
    PFNEGLMAKECURRENTPROC make_current_;
    PFNEGLGETCURRENTCONTEXTPROC get_current_;
};

}  // namespace aftershade::test
