// The ways to GL.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace aftershade::gpu {

/// Which library and which kind of renderer. `automatic` tries egl, egl_software and osmesa in this order,
/// and `software` the last two, which draw the same bits.
enum class Backend { automatic, egl, egl_software, osmesa, software };

/// "auto", "egl", "software", "egl-software", "osmesa"; nullopt for anything else.
std::optional<Backend> parse_backend(std::string_view name);
std::string_view backend_name(Backend backend);
/// What parse_backend() takes, for messages: "auto, egl, software, egl-software, osmesa".
std::string backend_names();

/// What a context is made with; a Backend alone is a choice, too.
struct GlChoice {
    GlChoice(Backend chosen = Backend::automatic, std::string name = "")
        : backend(chosen), device(std::move(name)) {}
    Backend backend;
    std::string device;  ///< a name of a Device (device.h); "" and "all": any that is not hidden
};

/// Loads OSMesa's library, where that is the backend: a thread may while the caller reads its documents. What
/// fails here fails again, and says why, where the context is made. [any thread]
void load_ahead(Backend backend) noexcept;

/// An EGLDisplay and an EGLContext of desktop OpenGL.
struct SharedEglContext {
    void* display = nullptr;
    void* context = nullptr;
};

}  // namespace aftershade::gpu
