#include "framework/gpu/egl_platform.h"

#include <cstdlib>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <fmt/format.h>
#include <glad/egl.h>

#include "framework/base/error.h"

namespace aftershade::gpu {
namespace {

constexpr unsigned int kGlRenderer = 0x1F01;
constexpr EGLint kDrmDeviceFile = 0x3233;  // EGL_EXT_device_drm

void* egl_library() {
    static void* const handle = open_library({"libEGL.so.1"}, "libegl1");
    return handle;
}

/// The entry points used here. glad's own EGL table is global, so only its types are taken.
struct EglApi {
    PFNEGLGETPROCADDRESSPROC get_proc_address;
    PFNEGLGETERRORPROC get_error;
    PFNEGLQUERYSTRINGPROC query_string;
    PFNEGLGETPLATFORMDISPLAYPROC get_platform_display;
    PFNEGLINITIALIZEPROC initialize;
    PFNEGLBINDAPIPROC bind_api;
    PFNEGLCHOOSECONFIGPROC choose_config;
    PFNEGLCREATECONTEXTPROC create_context;
    PFNEGLDESTROYCONTEXTPROC destroy_context;
    PFNEGLMAKECURRENTPROC make_current;
    PFNEGLGETCURRENTCONTEXTPROC get_current_context;
    PFNEGLQUERYCONTEXTPROC query_context;
    PFNEGLQUERYDEVICESEXTPROC query_devices;             // null where there is no EGL_EXT_device_base
    PFNEGLQUERYDEVICESTRINGEXTPROC query_device_string;  // likewise
};

template <typename Function>
void load(Function& function, const char* name) {
    void* address = dlsym(egl_library(), name);
    if (!address) throw Error(ErrorKind::gl, fmt::format("libEGL.so.1 has no {}; EGL 1.5 is needed", name));
    function = reinterpret_cast<Function>(address);
}

bool has_extension(const char* extensions, std::string_view name) {
    const std::string padded = fmt::format(" {} ", extensions ? extensions : "");
    return padded.find(fmt::format(" {} ", name)) != std::string::npos;
}

EglApi load_egl() {
    EglApi egl{};
    load(egl.get_proc_address, "eglGetProcAddress");
    load(egl.get_error, "eglGetError");
    load(egl.query_string, "eglQueryString");
    load(egl.get_platform_display, "eglGetPlatformDisplay");
    load(egl.initialize, "eglInitialize");
    load(egl.bind_api, "eglBindAPI");
    load(egl.choose_config, "eglChooseConfig");
    load(egl.create_context, "eglCreateContext");
    load(egl.destroy_context, "eglDestroyContext");
    load(egl.make_current, "eglMakeCurrent");
    load(egl.get_current_context, "eglGetCurrentContext");
    load(egl.query_context, "eglQueryContext");
    const char* client = egl.query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const bool enumerates = has_extension(client, "EGL_EXT_device_base") ||
                            (has_extension(client, "EGL_EXT_device_enumeration") &&
                             has_extension(client, "EGL_EXT_device_query"));
    if (enumerates && has_extension(client, "EGL_EXT_platform_device")) {
        egl.query_devices =
            reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(egl.get_proc_address("eglQueryDevicesEXT"));
        egl.query_device_string =
            reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(egl.get_proc_address("eglQueryDeviceStringEXT"));
    }
    return egl;
}

std::string error_name(EGLint code) {
    switch (code) {
        case EGL_NOT_INITIALIZED: return "EGL_NOT_INITIALIZED";
        case EGL_BAD_ACCESS: return "EGL_BAD_ACCESS";
        case EGL_BAD_ALLOC: return "EGL_BAD_ALLOC";
        case EGL_BAD_ATTRIBUTE: return "EGL_BAD_ATTRIBUTE";
        case EGL_BAD_CONFIG: return "EGL_BAD_CONFIG";
        case EGL_BAD_CONTEXT: return "EGL_BAD_CONTEXT";
        case EGL_BAD_DISPLAY: return "EGL_BAD_DISPLAY";
        case EGL_BAD_MATCH: return "EGL_BAD_MATCH";
        case EGL_BAD_PARAMETER: return "EGL_BAD_PARAMETER";
        default: return fmt::format("EGL error 0x{:04x}", code);
    }
}

/// A variable for the life of the object; Mesa reads LIBGL_ALWAYS_SOFTWARE inside eglInitialize only.
class ScopedVariable {
public:
    ScopedVariable(const char* name, const char* value) : name_(name) {
        if (const char* old = std::getenv(name)) old_ = old;
        setenv(name, value, 1);
    }
    ~ScopedVariable() {
        if (old_) {
            setenv(name_, old_->c_str(), 1);
        } else {
            unsetenv(name_);
        }
    }
    ScopedVariable(const ScopedVariable&) = delete;
    ScopedVariable& operator=(const ScopedVariable&) = delete;

private:
    const char* name_;
    std::optional<std::string> old_;
};

/// A display worth trying.
struct Candidate {
    EGLenum platform = 0;
    void* native = nullptr;
    std::string name;
    bool force_software = false;
};

class EglPlatform : public Platform {
public:
    EglPlatform(const EglApi& egl, const Candidate& candidate) : egl_(egl), name_(candidate.name) {
        display_ = egl_.get_platform_display(candidate.platform, candidate.native, nullptr);
        if (display_ == EGL_NO_DISPLAY) fail("eglGetPlatformDisplay");
        initialize(candidate.force_software);
        open_context(EGL_NO_CONTEXT);
    }

    /// The display is the caller's, and initialised.
    EglPlatform(const EglApi& egl, const SharedEglContext& shared)
        : egl_(egl), name_("the shared EGL display"), display_(shared.display) {
        EGLint client = 0;
        if (!egl_.query_context(display_, shared.context, EGL_CONTEXT_CLIENT_TYPE, &client))
            fail("eglQueryContext of the shared context");
        if (client != EGL_OPENGL_API)
            throw Error(ErrorKind::gl, "the shared context is not of desktop OpenGL");
        open_context(shared.context);
    }

    std::unique_ptr<Platform> sibling() const override {
        auto made = std::unique_ptr<EglPlatform>(new EglPlatform(egl_, name_, display_));
        made->make_current();
        return made;
    }

    // No eglTerminate: a display belongs to the process, and ending it would end the other contexts on it.
    ~EglPlatform() override { egl_.destroy_context(display_, context_); }

    void make_current() override {
        // The API that a thread works with is what its last caller chose.
        egl_.bind_api(EGL_OPENGL_API);
        if (!egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) fail("eglMakeCurrent");
    }

    bool is_current() const noexcept override { return egl_.get_current_context() == context_; }

    void release() noexcept override {
        egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }

    Proc proc(const char* name) const override { return reinterpret_cast<Proc>(egl_.get_proc_address(name)); }

private:
    /// On a display that is initialised.
    EglPlatform(const EglApi& egl, std::string name, EGLDisplay display)
        : egl_(egl), name_(std::move(name)), display_(display) {
        open_context(EGL_NO_CONTEXT);
    }

    void open_context(EGLContext shared) {
        if (!has_extension(egl_.query_string(display_, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")) {
            throw Error(ErrorKind::gl, fmt::format("{}: no EGL_KHR_surfaceless_context", name_));
        }
        if (!egl_.bind_api(EGL_OPENGL_API)) fail("eglBindAPI(EGL_OPENGL_API)");
        // What an untrusted shader reads outside its buffers is then defined, where the driver offers that.
        context_ = create_context(shared, true);
        if (context_ == EGL_NO_CONTEXT) context_ = create_context(shared, false);
        if (context_ == EGL_NO_CONTEXT) fail("eglCreateContext(GL 4.5 core)");
    }

    EGLContext create_context(EGLContext shared, bool robust) {
        const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                     4,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     5,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                     EGL_CONTEXT_OPENGL_DEBUG,
                                     EGL_TRUE,
                                     robust ? EGL_CONTEXT_OPENGL_ROBUST_ACCESS : EGL_NONE,
                                     EGL_TRUE,
                                     EGL_NONE};
        return egl_.create_context(display_, config(), shared, attributes);
    }

    void initialize(bool force_software) {
        std::optional<ScopedVariable> variable;
        if (force_software) variable.emplace("LIBGL_ALWAYS_SOFTWARE", "1");
        if (egl_.initialize(display_, nullptr, nullptr)) return;
        throw Error(
            ErrorKind::gl,
            fmt::format("{}: eglInitialize failed ({}): the driver does not load or may not open its device; "
                        "EGL_LOG_LEVEL=debug makes it say why",
                        name_, error_name(egl_.get_error())));
    }

    EGLConfig config() const {
        if (has_extension(egl_.query_string(display_, EGL_EXTENSIONS), "EGL_KHR_no_config_context")) {
            return EGL_NO_CONFIG_KHR;
        }
        const EGLint attributes[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                     EGL_NONE};
        EGLConfig result = nullptr;
        EGLint count = 0;
        if (!egl_.choose_config(display_, attributes, &result, 1, &count)) fail("eglChooseConfig");
        if (count == 0) throw Error(ErrorKind::gl, fmt::format("{}: no config for OpenGL", name_));
        return result;
    }

    [[noreturn]] void fail(std::string_view call) const {
        throw Error(ErrorKind::gl,
                    fmt::format("{}: {} failed ({})", name_, call, error_name(egl_.get_error())));
    }

    EglApi egl_;
    std::string name_;
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
};

std::vector<Candidate> device_candidates(const EglApi& egl, Renderer kind) {
    EGLint count = 0;
    if (!egl.query_devices || !egl.query_devices(0, nullptr, &count) || count <= 0) return {};
    std::vector<EGLDeviceEXT> devices(count);
    egl.query_devices(count, devices.data(), &count);
    devices.resize(count);
    std::vector<Candidate> result;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const char* extensions = egl.query_device_string(devices[i], EGL_EXTENSIONS);
        const bool software = has_extension(extensions, "EGL_MESA_device_software");
        if (software != (kind == Renderer::software)) continue;
        std::string name = fmt::format("EGL device {}", i);
        if (has_extension(extensions, "EGL_EXT_device_drm")) {
            if (const char* file = egl.query_device_string(devices[i], kDrmDeviceFile)) name = file;
        }
        result.push_back({EGL_PLATFORM_DEVICE_EXT, devices[i], name, false});
    }
    return result;
}

std::unique_ptr<Platform> open_candidate(const EglApi& egl, const Candidate& candidate, Renderer kind) {
    auto platform = std::make_unique<EglPlatform>(egl, candidate);
    platform->make_current();
    const std::string renderer = gl_string(*platform, kGlRenderer);
    std::string refusal;
    // eglMakeCurrent can succeed on a null context.
    if (gl_string(*platform, kGlVersion).empty()) {
        refusal = "eglMakeCurrent succeeded but there is no GL (GL_VERSION is null)";
    } else if (is_software_renderer(renderer) && kind == Renderer::hardware) {
        refusal = fmt::format("{} is a software renderer; egl-software takes it", renderer);
    } else if (!is_software_renderer(renderer) && kind == Renderer::software) {
        refusal = fmt::format("{} is not a software renderer; egl takes it", renderer);
    }
    if (refusal.empty()) return platform;
    platform->release();
    throw Error(ErrorKind::gl, fmt::format("{}: {}", candidate.name, refusal));
}

}  // namespace

std::unique_ptr<Platform> make_egl_platform(const SharedEglContext& shared) {
    if (!shared.display || !shared.context)
        throw Error(ErrorKind::usage, "the shared EGL display and context may not be null");
    auto platform = std::make_unique<EglPlatform>(load_egl(), shared);
    platform->make_current();
    if (!gl_string(*platform, kGlVersion).empty()) return platform;
    platform->release();
    throw Error(ErrorKind::gl, "eglMakeCurrent succeeded but there is no GL (GL_VERSION is null)");
}

std::unique_ptr<Platform> make_egl_platform(Renderer kind) {
    // One at a time in the process: ScopedVariable changes its environment.
    static std::mutex opening;
    const std::lock_guard lock(opening);
    const EglApi egl = load_egl();
    std::vector<Candidate> candidates = device_candidates(egl, kind);
    const char* client = egl.query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (kind == Renderer::software && has_extension(client, "EGL_MESA_platform_surfaceless")) {
        candidates.push_back({EGL_PLATFORM_SURFACELESS_MESA, nullptr, "EGL surfaceless", true});
    }
    std::string reasons;
    for (const Candidate& candidate : candidates) {
        try {
            return open_candidate(egl, candidate, kind);
        } catch (const Error& error) {
            reasons += (reasons.empty() ? "" : "; ") + std::string(error.what());
        }
    }
    if (!reasons.empty()) throw Error(ErrorKind::gl, reasons);
    throw Error(ErrorKind::gl,
                kind == Renderer::hardware
                    ? "EGL lists no hardware device"
                    : "EGL lists no software device: it finds no Mesa among its vendors (Debian "
                      "package libegl-mesa0), or __EGL_VENDOR_LIBRARY_FILENAMES leaves it out");
}

}  // namespace aftershade::gpu
