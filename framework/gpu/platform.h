// What a library (EGL, OSMesa) must do for a Context. Internal to framework/gpu, free of GL, EGL and OSMesa
// types.
#pragma once

#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "framework/base/error.h"
#include "framework/gpu/backend.h"

namespace aftershade::gpu {

/// One GL 4.5 core context without a window; current once it is made.
class Platform {
public:
    using Proc = void (*)();

    Platform() = default;
    virtual ~Platform() = default;
    Platform(const Platform&) = delete;
    Platform& operator=(const Platform&) = delete;

    /// Throws Error(ErrorKind::gl).
    virtual void make_current() = 0;
    /// Whether it is current in this thread still, whatever other code made current since.
    virtual bool is_current() const noexcept = 0;
    /// Leaves this thread without a context.
    virtual void release() noexcept = 0;
    /// Another of the same library and renderer, with objects of its own; current in this
    /// thread once it is made. Throws Error(ErrorKind::gl). [any thread]
    virtual std::unique_ptr<Platform> sibling() const = 0;
    virtual Proc proc(const char* name) const = 0;
    /// The device that it draws on: "/dev/dri/card0", "EGL device 1"; "" where it has none.
    virtual std::string device() const { return ""; }
};

/// True for the GL_RENDERER of a CPU rasteriser.
bool is_software_renderer(std::string_view renderer);

/// A library that is not there. `advice` says how to have it, for those who need it.
class AbsentLibrary : public Error {
public:
    AbsentLibrary(const std::string& reason, std::string advice)
        : Error(ErrorKind::gl, reason), advice_(std::move(advice)) {}
    const std::string& advice() const { return advice_; }

private:
    std::string advice_;
};

/// dlopen of the first of `names` that loads. Throws AbsentLibrary, which names the Debian package, where
/// none is there; Error with the loader's words where one is and cannot be loaded.
void* open_library(std::initializer_list<const char*> names, std::string_view package);

/// GL_VERSION, for gl_string().
inline constexpr unsigned int kGlVersion = 0x1F02;

/// glGetString through `platform`; empty where GL gives null, which is how a null context shows itself.
std::string gl_string(const Platform& platform, unsigned int name);

enum class Renderer { hardware, software };

/// EGL without a window, opened at run time. Tries every EGL device of the kind and the name asked for ("":
/// any); a renderer of the other kind is refused. Throws Error(ErrorKind::gl) whose message is the reason
/// alone, and Error(ErrorKind::usage) where no device has the name.
std::unique_ptr<Platform> make_egl_platform(Renderer kind, const std::string& device);
/// A context that shares objects with the caller's, of whichever renderer. Throws likewise.
std::unique_ptr<Platform> make_egl_platform(const SharedEglContext& shared);

/// OSMesa, opened at run time. Throws Error(ErrorKind::gl) whose message is the reason alone.
std::unique_ptr<Platform> make_osmesa_platform();
/// Throws Error(ErrorKind::gl).
void load_osmesa();

}  // namespace aftershade::gpu
