// The present activity of this process, reported to the process that started it, which can then attribute
// a crash.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>

namespace aftershade {

/// The environment variable with the number of the pipe's file descriptor.
inline constexpr const char* kStatusFdVariable = "AFTERSHADE_STATUS_FD";

/// Where a process is. Empty fields are not known, or do not apply.
struct WorkStatus {
    std::string step;    ///< of the look
    std::string plugin;  ///< the library whose code runs; empty while none does
    std::string phase;   ///< "load", "create", "prepare", ... of a plug-in; "compile" or "draw" of a pass
    std::optional<int> frame;
    std::string effect{};     ///< of the pass
    std::string pass{};       ///< that is compiled or drawn; empty while none is
    bool is_foreign = false;  ///< whether the effect is not one of the shipped ones

    bool operator==(const WorkStatus&) const = default;
};

/// How one frame of a run ended, for the process that started this one.
struct FrameEvent {
    int frame = 0;
    std::string outcome;  ///< "done", "failed", "skipped"; "current": an earlier run has made it
    double seconds = 0;
    std::string message;  ///< why it failed; long ones lose their ends

    bool operator==(const FrameEvent&) const = default;
};

/// Whether a frame had an object that the look names, for the process that started this one.
struct ObjectSighting {
    int index = 0;  ///< of the pipeline's objects, in ObjectMatches
    bool is_found = false;
    double px = 0;  ///< the width of an entry that needs one

    bool operator==(const ObjectSighting&) const = default;
};

/// What a process draws with, for the process that started it.
struct DrawnBy {
    std::string renderer;        ///< "egl: NVIDIA H100 ..., 4.6.0 ..."
    std::string device;          ///< "/dev/dri/card0"; "" where it has none
    std::string hardware_fault;  ///< why backend auto took software; "" where it did not

    bool operator==(const DrawnBy&) const = default;
};

/// One line of JSON with its line end: {"event":"frame","frame":12,"outcome":"done","seconds":0.5}. Never
/// longer than PIPE_BUF.
std::string event_line(const FrameEvent& event);

/// One line of JSON with its line end: {"event":"object","index":3,"found":true,"px":0.0}.
std::string sighting_line(const ObjectSighting& sighting);

/// One line of JSON with its line end: {"event":"gl","renderer":"...","device":"...","hardware_fault":"..."}.
/// Never longer than PIPE_BUF: a long reason loses its end.
std::string drawn_by_line(const DrawnBy& gl);

/// One line of JSON with its line end: {"event":"end","code":0}.
std::string last_word_line(int exit_code);

/// " in prepare of step 'grade', frame 12", " while compiling pass 'main' of step 'grade' (effect 'tint')";
/// "" where nothing is known.
std::string place_text(const WorkStatus& status);

/// One line of JSON with its line end: {"step":"grade","plugin":"/x/libfoo.so","phase":"prepare","frame":12}.
/// Never longer than PIPE_BUF, so that a write is whole: long names lose their beginnings.
std::string status_line(const WorkStatus& status);

/// Writes to the pipe that AFTERSHADE_STATUS_FD names; does nothing where the variable is absent or names no
/// pipe. [thread-safe; scopes nest on one thread]
class StatusWriter {
public:
    StatusWriter();
    /// Calls a listener in this process instead, on the thread that writes.
    explicit StatusWriter(std::function<void(const WorkStatus&)> listener);
    StatusWriter(const StatusWriter&) = delete;
    StatusWriter& operator=(const StatusWriter&) = delete;

    bool active() const { return descriptor_ >= 0 || listener_; }
    void write(const WorkStatus& status);
    void write(const FrameEvent& event);
    void write(const ObjectSighting& sighting);
    void write(const DrawnBy& gl);
    /// Last of all: without it an exit code counts for nothing, since any library may call exit().
    void end(int exit_code);
    WorkStatus current() const;

private:
    void send(const std::string& line);

    int descriptor_ = -1;
    std::function<void(const WorkStatus&)> listener_;
    mutable std::mutex mutex_;
    WorkStatus current_;
};

/// Says `status` while it lives, and again what was said before when it goes. A null writer is allowed.
class StatusScope {
public:
    StatusScope(StatusWriter* writer, const WorkStatus& status);
    ~StatusScope();
    StatusScope(const StatusScope&) = delete;
    StatusScope& operator=(const StatusScope&) = delete;

private:
    StatusWriter* writer_;
    WorkStatus before_;
};

}  // namespace aftershade
