#include <array>
#include <mutex>

#include <dlfcn.h>

#include "framework/base/error.h"
#include "framework/gpu/egl_current.h"
#include "framework/gpu/platform.h"

#if defined(__SANITIZE_ADDRESS__)
// OSMesaMakeCurrent keeps 160 bytes for each context to the end of the process (Mesa 22.3).
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libOSMesa\n";
}
#endif

namespace aftershade::gpu {
namespace {

// From GL/osmesa.h of Mesa 22.3. Not included: Mesa 25.1 dropped the header with the library.
constexpr int kOsmesaFormat = 0x22;
constexpr int kOsmesaRgba = 0x1908;
constexpr int kOsmesaProfile = 0x33;
constexpr int kOsmesaCoreProfile = 0x34;
constexpr int kOsmesaMajorVersion = 0x36;
constexpr int kOsmesaMinorVersion = 0x37;
constexpr unsigned int kUnsignedByte = 0x1401;

// OSMesa demands a buffer to be current; every pass draws to textures, so it is never looked at.
constexpr int kBufferSide = 16;

using OsmesaContext = void*;

void* osmesa_library() {
    static void* const handle =
        open_library({"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"},
                     "libosmesa6 (Debian up to 13; Mesa 25.1 and later have no OSMesa)");
    return handle;
}

template <typename Function>
Function symbol(const char* name) {
    void* address = dlsym(osmesa_library(), name);
    if (!address)
        throw Error(ErrorKind::gl, std::string("libOSMesa has no ") + name + "; Mesa 12 or later is needed");
    return reinterpret_cast<Function>(address);
}

/// OSMesa makes its screen and links what is current without a lock of its own.
std::mutex& osmesa_mutex() {
    static std::mutex mutex;
    return mutex;
}

class OsmesaPlatform : public Platform {
public:
    OsmesaPlatform()
        : destroy_(symbol<void (*)(OsmesaContext)>("OSMesaDestroyContext")),
          make_current_(symbol<MakeCurrent>("OSMesaMakeCurrent")),
          get_current_(symbol<OsmesaContext (*)()>("OSMesaGetCurrentContext")),
          get_proc_(symbol<Proc (*)(const char*)>("OSMesaGetProcAddress")) {
        const auto create =
            symbol<OsmesaContext (*)(const int*, OsmesaContext)>("OSMesaCreateContextAttribs");
        const int attributes[] = {kOsmesaFormat,
                                  kOsmesaRgba,
                                  kOsmesaProfile,
                                  kOsmesaCoreProfile,
                                  kOsmesaMajorVersion,
                                  4,
                                  kOsmesaMinorVersion,
                                  5,
                                  0};
        const std::lock_guard lock(osmesa_mutex());
        context_ = create(attributes, nullptr);
        if (!context_)
            throw Error(ErrorKind::gl, "OSMesa makes no GL 4.5 core context; install Mesa 22 or later");
    }

    ~OsmesaPlatform() override {
        const std::lock_guard lock(osmesa_mutex());
        destroy_(context_);
    }

    void make_current() override {
        const std::lock_guard lock(osmesa_mutex());
        if (!make_current_(context_, buffer_.data(), kUnsignedByte, kBufferSide, kBufferSide)) {
            throw Error(ErrorKind::gl, "OSMesaMakeCurrent failed");
        }
    }

    bool is_current() const noexcept override {
        return get_current_() == context_ && !current_egl_context().context;
    }

    void release() noexcept override {
        const std::lock_guard lock(osmesa_mutex());
        make_current_(nullptr, nullptr, 0, 0, 0);
    }

    std::unique_ptr<Platform> sibling() const override { return make_osmesa_platform(); }

    Proc proc(const char* name) const override { return get_proc_(name); }

private:
    using MakeCurrent = unsigned char (*)(OsmesaContext, void*, unsigned int, int, int);

    void (*destroy_)(OsmesaContext);
    MakeCurrent make_current_;
    OsmesaContext (*get_current_)();
    Proc (*get_proc_)(const char*);
    OsmesaContext context_ = nullptr;
    std::array<unsigned char, 4 * kBufferSide * kBufferSide> buffer_{};
};

}  // namespace

void load_osmesa() {
    osmesa_library();
}

std::unique_ptr<Platform> make_osmesa_platform() {
    auto platform = std::make_unique<OsmesaPlatform>();
    platform->make_current();
    if (gl_string(*platform, kGlVersion).empty()) {
        platform->release();
        throw Error(ErrorKind::gl, "OSMesaMakeCurrent succeeded but there is no GL (GL_VERSION is null)");
    }
    return platform;
}

}  // namespace aftershade::gpu
