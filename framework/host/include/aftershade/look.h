// Looks: chains of effects, and what they make of frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "aftershade/capture.h"
#include "aftershade/effects.h"
#include "aftershade/error.h"
#include "aftershade/export.h"
#include "aftershade/gl.h"
#include "aftershade/image.h"

namespace aftershade::host {

class Access;
class Host;

/// Handling of images of the capture or of the result with pixels that are NaN or infinite. Positive
/// infinity is valid in roles whose outside is infinite, such as depth. Textures are not checked.
enum class NonFinite {
    ignore,  ///< do not look for them
    report,  ///< count them in Result::non_finite
    fail,    ///< Error(capture)
    mend     ///< replace them from the pixels around, in captures before the effects see them, and report
};

/// How a frame is rendered. Objects that it points to need not outlive the call.
struct RenderOptions {
    /// Roles to be given back. Empty: every role that some step makes, else color. One that no step makes is
    /// the capture's own; one that neither has is Error(capture).
    std::vector<std::string> roles{};
    /// Textures of HostOptions::share that results are written into; such a role is not read back. They must
    /// have the data window's size, and some step must make their role, else Error(usage).
    std::map<std::string, GlTexture> targets{};
    void* wait = nullptr;      ///< a GLsync: see gl.h; nullptr: the caller's commands have finished
    bool wants_fence = false;  ///< see gl.h; false: the call returns when the targets are written

    bool timed = false;      ///< fill Result::times; waits for each pass
    bool telemetry = false;  ///< fill Result::statistics; reads the effects' textures back
    NonFinite non_finite = NonFinite::report;

    /// Neighbours for effects that look at them, of the same shot and of the size of the frame; nullptr:
    /// there is none, as at the ends of a shot. Effects that look further do with these alone.
    const Capture* previous = nullptr;
    const Capture* next = nullptr;
    bool begins_shot = false;  ///< a cut: nothing before it counts. Sessions only; elsewhere it always is one
    double fps = 24;           ///< frames a second, for effects that need it; above 0, finite
    /// A stop that is requested before the frame's passes begin ends the call with
    /// Error(interrupted). Earlier results stay valid.
    std::stop_token stop{};
};

struct PassTime {
    std::string pass;         ///< "bokeh.coc"; "upload" and "readback" for the copies
    double milliseconds = 0;  ///< of wall time on software GL, of GPU time elsewhere
};

/// A number of an effect on the frame (docs/looks.md).
struct StatisticInfo {
    std::string step, name;
    std::int64_t count = 0;       ///< texels; with 0 of them the numbers below are 0
    std::int64_t non_finite = 0;  ///< NaN and infinities, not in `count`
    double sum = 0, mean = 0, deviation = 0, min = 0, max = 0;
    double histogram_from = 0, histogram_to = 0;
    std::vector<std::int64_t> histogram;  ///< empty: the effect declares none
};

struct NonFiniteInfo {
    std::string image;                   ///< a role, or a tap: "bokeh.coc"
    bool of_capture = false;             ///< else of the result
    int x = 0, y = 0;                    ///< the first such pixel
    std::int64_t nan = 0, infinite = 0;  ///< pixels
    bool mended = false;
};

/// How files are written. Defaults are those of `aftershade run`.
struct WriteOptions {
    std::vector<std::string> roles{"color"};  ///< in EXR files
    bool half = true;                         ///< color and what is like it as half; false: as float
    bool crop_to_display = false;             ///< EXR: only the display window's pixels
    std::string compression = "zip";  ///< EXR: none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa, dwab
};

/// The result of a look for one frame. Copies share their pixels. [value type; thread-safe to read]
class AFTERSHADE_API Result {
public:
    Result(const Result&) noexcept;
    Result& operator=(const Result&) noexcept;
    ~Result();

    int frame() const noexcept;
    /// Whether a further sub-frame is needed before there are images (Session::render_subframe).
    bool is_pending() const noexcept;
    std::vector<std::string> roles() const;  ///< that were read back, sorted
    /// Throws Error(usage) where the role was not given back.
    Image image(const std::string& role) const;
    std::vector<std::string> taps() const;  ///< LookOptions::taps
    Image tap(const std::string& name) const;

    std::vector<PassTime> times() const;            ///< in order; empty unless RenderOptions::timed
    std::vector<StatisticInfo> statistics() const;  ///< empty unless RenderOptions::telemetry
    std::vector<NonFiniteInfo> non_finite() const;
    std::vector<std::string> messages() const;  ///< that plug-ins logged
    std::vector<std::string> notes() const;     ///< on how its capture was read: Capture::notes()
    std::string history_reset() const;  ///< why history began with this frame; "": it continued, or is none
    std::uint64_t gpu_bytes() const noexcept;  ///< of the frame's textures and buffers
    /// The GLsync of RenderOptions::wants_fence, which the caller deletes; nullptr without.
    void* fence() const noexcept;

    /// Writes a .exr or .png ("####" stands for the frame's number), as `aftershade run` does: roles that no
    /// step made are the capture's, a .png takes display, else color as sRGB. The file appears whole or not
    /// at all. Throws Error(usage) for an unknown extension, role or compression, Error(output) where it
    /// cannot be written.
    void write(const std::filesystem::path& path, const WriteOptions& options = {}) const;

    struct AFTERSHADE_LOCAL Data;  ///< what the library keeps; no part of the API

private:
    friend class Access;
    explicit Result(std::shared_ptr<const Data> data);
    std::shared_ptr<const Data> data_;
};

/// Renders frames in order, with the history that effects keep from one frame to the next. It has GPU memory
/// of its own; several sessions of one look do not disturb each other. History restarts at a gap in the frame
/// numbers. Move only. [the host's thread; may be destroyed on any]
class AFTERSHADE_API Session {
public:
    Session(Session&&) noexcept;
    Session& operator=(Session&&) noexcept;
    ~Session();

    /// Renders the next frame. After an error the session continues with the next frame. Throws as
    /// Look::render.
    Result render(const Capture& capture, const RenderOptions& options = {});
    /// Renders the `index`-th capture, from 0, of a frame that consists of `count` captures (sub-frames, for
    /// effects that accumulate them). Call it for each in turn, all with the frame's number. The last result
    /// has the images.
    Result render_subframe(const Capture& capture, int index, int count, const RenderOptions& options = {});
    /// Reads what the look needs of a frame, with its sub-frames, neighbours, cuts and frame rate, and
    /// renders it, as `aftershade run` does; the frame behind it is read at the same time. Options that the
    /// sequence decides (previous, next, begins_shot, fps) must have their defaults. Throws Error(usage)
    /// where the sequence has no such frame.
    Result render(const Sequence& sequence, int frame, const RenderOptions& options = {});
    /// Forgets every frame.
    void reset();

    /// Writes what the next frame would read of this one. Throws Error(output).
    void save_history(const std::filesystem::path& path);
    /// Continues where a session of the same look ended. Throws Error(usage) where the file is damaged or of
    /// another look or effect version: at once, or, where size or frame do not fit, by the next render.
    void load_history(const std::filesystem::path& path);

    struct AFTERSHADE_LOCAL Data;  ///< what the library keeps; no part of the API

private:
    friend class Access;
    explicit Session(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

/// A parameter of a step, with its value now.
struct LookParam {
    std::string name;    ///< "bokeh.f_number": what set() and get() take
    std::string step;    ///< "bokeh"
    ParamInfo info;      ///< as the effect declares it
    Value value;         ///< now; a Json where it depends on the frame
    std::string origin;  ///< "the manifest", "preset fast", "the look", "set"
};

/// How a look is loaded. Names are kept for messages.
struct LookOptions {
    std::vector<std::string> taps{};           ///< "step.texture": intermediates that each result has too
    std::map<std::string, Value> variables{};  ///< above the look's own "vars"
    /// For a look that is given as text: the folder that its files are relative to (empty: the working
    /// directory), and the text's name in messages.
    std::filesystem::path folder{};
    std::string name = "look text";
};

/// Made by Host::load_look. Owns all that it needs but the Host's context: once the Host is closed or
/// destroyed, every call is Error(usage). Move only. [the host's thread; may be destroyed on any]
class AFTERSHADE_API Look {
public:
    Look(Look&&) noexcept;
    Look& operator=(Look&&) noexcept;
    ~Look();

    std::vector<std::string> steps() const;  ///< that run, in order
    std::vector<LookParam> params() const;   ///< of each step, in the order of its effect; without "mix"
    /// Roles that the look takes from captures, required or not.
    std::vector<std::string> inputs() const;
    std::vector<std::string> outputs() const;  ///< roles that some step makes
    bool has_history() const;                  ///< a frame depends on those before it: use a Session
    std::vector<Diagnostic> warnings() const;  ///< of loading

    /// Sets "step.param", or "step.mix" (0: the image as it was before the step, to 1). Holds for the next
    /// frame, of sessions too. A number is in the parameter's unit; text may bring its own ("2 m"). Paths are
    /// named from the working directory. Throws Error(usage) naming every fault: no such step or parameter, a
    /// value of the wrong type or out of its range, a relation to another parameter that no longer holds. The
    /// look is then as it was.
    void set(const std::string& name, const Value& value);
    /// Several at once, so that relations are checked against all of them.
    void set(const std::map<std::string, Value>& values);
    /// As the look, its preset or the manifest gives it. Throws Error(usage) for unknown names.
    void reset(const std::string& name);
    /// Throws Error(usage) for unknown names.
    Value get(const std::string& name) const;

    /// Renders a frame by itself: history begins with it. Throws Error(usage) for options out of range.
    /// Throws Error(capture) if the capture lacks an image that a step requires, or has values that a step
    /// does not accept. Also throws Error(gl) with the first frame, Error(effect), Error(memory),
    /// Error(interrupted).
    Result render(const Capture& capture, const RenderOptions& options = {});
    /// Reads the images that the look needs from a file, pattern, folder or capture.json, of its first frame.
    /// The result is that of Capture::read, except for objects that the look names. Throws as Capture::read.
    Capture read(const std::filesystem::path& path, const CaptureOptions& options = {}) const;
    Session session();

    struct AFTERSHADE_LOCAL Data;  ///< what the library keeps; no part of the API

private:
    friend class Access;
    explicit Look(std::shared_ptr<Data> data);
    std::shared_ptr<Data> data_;
};

}  // namespace aftershade::host
