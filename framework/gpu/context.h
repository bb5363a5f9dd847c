// A GL 4.5 core context without a window, through EGL or OSMesa, both opened at run time.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "framework/gpu/backend.h"
#include "framework/gpu/transfer_use.h"

struct GladGLContext;

namespace aftershade::gpu {

struct ContextInfo {
    Backend backend = Backend::automatic;  ///< never `automatic` or `software` in a made context
    std::string renderer;                  ///< GL_RENDERER
    std::string version;                   ///< GL_VERSION
    std::string vendor;                    ///< GL_VENDOR
    bool software = false;                 ///< a CPU rasteriser (llvmpipe, softpipe, swrast)
    std::string device;  ///< that it draws on: "/dev/dri/card0", "EGL device 1"; "" where there is none
    std::string hardware_fault;  ///< of `automatic` that took software: "egl: EGL lists no hardware device"
    int load_units = 0;  ///< images of a shader where a load costs less than a texelFetch (llvmpipe), else 0
    bool maps_transfers = false;  ///< texels go through mapped buffers (docs/gpu.md), else as GL copies them
    int texture_side_px = 0;      ///< at most (GL_MAX_TEXTURE_SIZE)
};

/// One row of `aftershade doctor`.
struct BackendReport {
    Backend backend = Backend::automatic;
    bool usable = false;
    std::string reason;  ///< why not, with the package to install where that is known; empty when usable
    ContextInfo info;    ///< filled when usable
};

/// Tries egl, egl_software and osmesa in turn, each with the self-test, and leaves no context current.
std::vector<BackendReport> probe_backends();

/// A context whose renderer another one is to have.
struct SiblingOf {
    const class Context& context;
};

/// GL objects that are alive.
struct ObjectCounts {
    std::size_t buffers = 0, textures = 0, programs = 0;
    std::size_t framebuffers = 0, views = 0;  ///< made on first use, and kept as long as their textures
    std::size_t total() const { return buffers + textures + programs + framebuffers + views; }
};

/// When a context draws its self-test, which llvmpipe takes 40 ms to compile from an empty cache; threads may
/// compile the caller's programs meanwhile. With `at_first_use` test_once(), or the first draw or dispatch,
/// draws it, where the caller names a backend and the renderer is software. Else it is drawn at once: another
/// backend may have to take the context's place, and a driver may not fit its hardware.
enum class SelfTest { now, at_first_use };

/// Owns the GL context and its function table. Objects made from it keep a reference and must die first.
/// A self-test draws a known colour into a float framebuffer and reads it back; a context that cannot is
/// refused. [one thread: the one that made it; several contexts may exist in one process, make_current()
/// selects]
class Context {
public:
    /// Throws Error(ErrorKind::gl) that lists each backend tried, why it was refused, and a software backend
    /// that works in its place, and Error(ErrorKind::memory) where a limit leaves too little address space.
    /// Throws Error(ErrorKind::usage) where no device has the name of the choice.
    explicit Context(const GlChoice& choice, SelfTest when = SelfTest::now);
    /// On EGL, sharing textures, buffers and fences with a context of the caller's, which must outlive this
    /// one. Throws as the other.
    explicit Context(const SharedEglContext& shared);
    /// Of the renderer of one that works, so without a self-test. Each may work in a thread of its own.
    /// Throws Error(ErrorKind::gl). [any thread]
    explicit Context(SiblingOf other);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    const ContextInfo& info() const;
    /// Stays the same while the same work is done again.
    ObjectCounts objects() const;
    /// Since the context was made.
    TransferUse transfer_use() const;
    void make_current();
    /// The self-test that SelfTest::at_first_use has put off. Throws Error(ErrorKind::gl).
    void test_once();
    /// Whether a new texture holds zeros, as llvmpipe's do. Found out with memory that held something else;
    /// false on hardware, where GL leaves it open.
    bool zeroes_new_textures();
    /// Leaves this thread without it, so that another thread may make it current.
    void release() noexcept;
    /// After memory ran out: this context and its objects are never deleted. Mesa 22.3 may wait for ever in
    /// its clean-up for threads that ended then; the process that caught the failure should end (_exit).
    void abandon() noexcept;
    /// Waits until the driver has done everything asked so far (glFinish).
    void finish();
    /// Throws Error(ErrorKind::effect) if GL has reported an error (KHR_debug, or glGetError) since the last
    /// call, and Error(ErrorKind::memory) where that is GL_OUT_OF_MEMORY; the context is abandoned then.
    /// `what` names the pass or the operation, for the message.
    void check(std::string_view what);

    /// The function table; for framework/gpu only, which alone includes <glad/gl.h>.
    const GladGLContext& gl() const;

    struct Impl;                           ///< framework/gpu/context_internal.h
    Impl& impl() const { return *impl_; }  ///< for framework/gpu

private:
    std::unique_ptr<Impl> impl_;
};

}  // namespace aftershade::gpu
