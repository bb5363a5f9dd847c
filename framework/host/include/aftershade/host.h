// Aftershade as a library: chains of shader effects over frames with depth, motion vectors and more, on
// OpenGL 4.5, without a display. This header includes all others of the API.
//
//     using namespace aftershade::host;
//     Host host({.data = "/usr/share/aftershade"});
//     Look look = host.load_look("bokeh.json");
//     look.set("bokeh.f_number", 2.0);
//     look.render(Capture::read(host, "frame_0001.exr")).write("out.exr");
//
// Threads. A Host, its Looks and their Sessions belong to the thread that made the Host; a call from another
// one is Error(usage). detach() gives them to the thread that calls next. Several threads work at once with a
// Host each. Captures, Sequences, Images, Results and errors are values and belong to no Host.
//
// Nothing is global: no environment variable, no working directory (but to complete relative paths), no
// locale and no signal handler is read or changed, and two Hosts in one process share nothing. Two exceptions
// are not ours: Mesa reads its own variables (LIBGL_*, MESA_*, GALLIUM_*, LP_*), and a Host whose only
// software renderer is reached by EGL's surfaceless platform sets LIBGL_ALWAYS_SOFTWARE while its context is
// made. Variables that decide how a GPU is used, and never what is drawn, are read: CUDA_VISIBLE_DEVICES,
// AFTERSHADE_DRAW_WITH and AFTERSHADE_TRANSFERS.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "aftershade/capture.h"
#include "aftershade/compare.h"
#include "aftershade/effects.h"
#include "aftershade/error.h"
#include "aftershade/export.h"
#include "aftershade/gl.h"
#include "aftershade/image.h"
#include "aftershade/look.h"
#include "aftershade/velocity.h"
#include "aftershade/version.h"

namespace aftershade::host {

class Access;

/// Which library makes the context. `automatic` tries egl, egl_software and osmesa in this order.
enum class Backend {
    automatic,
    egl,           ///< a GPU
    egl_software,  ///< llvmpipe, through EGL
    osmesa,        ///< llvmpipe, through OSMesa, which Mesa has up to 25.0
    software       ///< egl_software, else osmesa: both draw the same bits
};

/// "auto", "egl", "egl-software", "osmesa", "software". Never fails.
AFTERSHADE_API const char* backend_name(Backend backend) noexcept;

struct HostLimits {
    int max_side_px = 16384;  ///< of images that are read; from 1 to 65536; beyond: Error(capture)
    /// Bytes of the channels that are read from one file; at least 1; above that: Error(capture).
    std::uint64_t max_image_bytes = 512ull * 1024 * 1024;
};

struct HostOptions {
    /// The folder that holds effects/, glsl/ and profiles/: <prefix>/share/aftershade. Must be given.
    std::filesystem::path data{};
    std::vector<std::filesystem::path> effect_paths{};   ///< of effects, searched before the shipped ones
    std::vector<std::filesystem::path> profile_paths{};  ///< of producers' profiles, likewise
    /// Folders of native plug-ins (*.so), whose code runs in this process. None are searched but these.
    std::vector<std::filesystem::path> plugin_paths{};
    Backend backend = Backend::automatic;
    std::optional<SharedEgl> share{};  ///< see gl.h; `backend` must then be `automatic` or an EGL one
    HostLimits limits{};
    /// Keeps compiled programs for later Hosts; made when it is needed; never fails. Empty: nothing is kept.
    std::filesystem::path cache{};
    /// The device to draw on, by a name that `aftershade doctor` lists: "0", "card0", "0000:65:00.0",
    /// "GPU-6bcd0a81", "cuda:0". Empty or "all": the first that works. Not with `share`.
    std::string device{};
};

struct GlInfo {
    Backend backend = Backend::automatic;  ///< never `automatic` or `software`
    std::string renderer, version, vendor;
    bool is_software = false;      ///< renders on the CPU
    std::string device{};          ///< "/dev/dri/card0", "EGL device 1"; empty where there is none
    std::string hardware_fault{};  ///< why `automatic` took software; empty where it did not
};

/// A name and one line.
struct NameAndSummary {
    std::string name;
    std::string summary;
};

/// Everything starts here. Move only. [the thread that made it; see above]
class AFTERSHADE_API Host {
public:
    /// Makes no GL context yet: the first frame does, or gl(). Throws Error(usage) naming every option that
    /// is wrong: a folder that is not there, a limit out of range. Profiles are read when they are first
    /// needed.
    explicit Host(HostOptions options);
    Host(Host&&) noexcept;
    Host& operator=(Host&&) noexcept;
    /// As close(). On a thread that does not own the Host, GL's objects are left to the process's end.
    ~Host();

    /// Frees the context and all that lies on the GPU. Looks and sessions that still live are of no use then:
    /// their calls, and those of this Host, are Error(usage). A second call does nothing.
    void close();
    bool is_closed() const noexcept;
    /// Gives the Host, its looks and its sessions to the thread that next calls one of them.
    void detach();

    /// Reads a look from a file. Throws Error(document) with every fault of the look and of the effects that
    /// it uses, Error(usage) for faults of `options`.
    Look load_look(const std::filesystem::path& path, const LookOptions& options = {});
    /// The same for a look's text: a JSON document.
    Look parse_look(std::string_view json, const LookOptions& options = {});

    /// Every effect, sorted by id; manifests are read from disk each time. Throws Error(document) with every
    /// fault of every manifest; with `faults`, these go there, and their effects are left out.
    std::vector<EffectInfo> effects(std::vector<Diagnostic>* faults = nullptr) const;
    /// One of them. Throws Error(usage) for an unknown id, Error(document) for faults of its manifest.
    EffectInfo effect(const std::string& id) const;
    std::vector<NameAndSummary> profiles() const;  ///< of producers of captures, sorted

    /// Makes the context, if there is none yet. Throws Error(gl) that lists each backend and why it was
    /// refused.
    GlInfo gl();

    struct AFTERSHADE_LOCAL Data;  ///< what the library keeps; no part of the API

private:
    friend class Access;
    std::shared_ptr<Data> data_;
};

/// The version of the library that the program runs with: "0.1.0". Never fails.
AFTERSHADE_API const char* library_version() noexcept;

}  // namespace aftershade::host
