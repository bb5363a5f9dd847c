#include <cstdlib>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/gpu/driver_faults.h"
#include "framework/gpu/egl_api.h"
#include "framework/gpu/platform.h"

namespace aftershade::gpu {
namespace {

constexpr unsigned int kGlRenderer = 0x1F01;

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

    std::string device() const override { return name_; }

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
        fail("eglInitialize");
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
                    fmt::format("{}: {} failed ({})", name_, call, egl_error_name(egl_.get_error())));
    }

    EglApi egl_;
    std::string name_;
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
};

std::vector<Candidate> device_candidates(const EglApi& egl, Renderer kind, const std::string& name) {
    const EglDevices found = egl_devices(egl);
    std::vector<Candidate> result;
    if (found.devices.empty()) return result;
    for (const Device& device : devices_named(found.devices, name))
        if (device.is_software == (kind == Renderer::software))
            result.push_back(
                {EGL_PLATFORM_DEVICE_EXT, found.handles[std::size_t(device.index)], device.name(), false});
        else if (names_one_device(name))
            throw Error(ErrorKind::gl, device.is_software
                                           ? device.text() + " draws in software; egl-software takes it"
                                           : device.text() + " is a GPU; egl takes it");
    if (result.empty() && kind == Renderer::hardware)
        if (const std::string hidden = hidden_text(found.devices); !hidden.empty())
            throw Error(ErrorKind::gl, hidden);
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

std::unique_ptr<Platform> make_egl_platform(Renderer kind, const std::string& device) {
    // One at a time in the process: ScopedVariable changes its environment.
    static std::mutex opening;
    const std::lock_guard lock(opening);
    const EglApi egl = load_egl();
    std::vector<Candidate> candidates = device_candidates(egl, kind, device);
    const char* client = egl.query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (kind == Renderer::software && !names_one_device(device) &&
        has_extension(client, "EGL_MESA_platform_surfaceless")) {
        candidates.push_back({EGL_PLATFORM_SURFACELESS_MESA, nullptr, "EGL surfaceless", true});
    }
    std::vector<std::string> reasons;
    for (const Candidate& candidate : candidates) {
        try {
            return open_candidate(egl, candidate, kind);
        } catch (const Error& error) {
            reasons.emplace_back(error.what());
        }
    }
    std::vector<std::string> faults =
        kind == Renderer::hardware ? hardware_faults("/") : software_faults("/");
    if (reasons.empty())
        reasons.emplace_back(kind == Renderer::hardware ? "EGL lists no hardware device"
                                                        : "EGL lists no software device");
    else if (faults.empty()) faults.emplace_back("EGL_LOG_LEVEL=debug makes the driver say more");
    reasons.insert(reasons.end(), faults.begin(), faults.end());
    throw Error(ErrorKind::gl, joined(reasons, "; ", "; "));
}

}  // namespace aftershade::gpu
