// Messages of `run` for people or programs, while it works and at the end. All go to stderr; stdout has the
// paths of the written files, one a line.
#pragma once

#include <chrono>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>

#include "framework/run/run_frames.h"

namespace aftershade::cli {

enum class ProgressStyle {
    none,      ///< warnings and errors alone
    plain,     ///< a line for each frame, for logs
    terminal,  ///< one line that changes
    json,      ///< an object a line (docs/looks.md)
    openjd     ///< plain, with what a farm of Open Job Description reads on stdout
};

/// "auto" is a terminal's line where stderr is one, else plain. Throws Error(ErrorKind::usage).
ProgressStyle parse_progress(const std::string& name);

/// "openjd_progress: 25.0" and "openjd_status: ..." on stdout:
/// https://github.com/OpenJobDescription/openjd-specifications/wiki/How-Jobs-Are-Run#stdoutstderr-messages
void print_openjd_progress(std::size_t done, std::size_t count, const std::string& status);

/// "aftershade: warning: ..." or {"event": "warning", "message": ...}
std::string warning_line(ProgressStyle style, const std::string& message);

/// "; backend auto found no usable hardware GL (...)"; "" without a fault.
std::string fallback_text(const std::string& hardware_fault);
/// What a machine with a GPU warns of then.
std::string software_warning(const std::string& hardware_fault);

/// A line of stdout, at once. Throws Error(ErrorKind::output).
void print_path(std::string_view path);

/// "12.5 frames/s, 48 s left": of `count` frames that many are done.
std::string rate_text(std::size_t done, std::size_t count, double elapsed_s);

/// The last line of stderr while a run works: on a terminal one that changes, else a line each time.
class ProgressLine {
public:
    /// Takes the line away that a terminal shows, before anything else is printed.
    void clear();
    void show(ProgressStyle style, const std::string& text);

private:
    bool is_shown_ = false;
};

class RunReporter {
public:
    /// The first of the `frame_count` frames only warm up history.
    RunReporter(ProgressStyle style, int frame_count, int warmup_frames, bool verbose)
        : style_(style), frame_count_(frame_count), warmup_frames_(warmup_frames), verbose_(verbose) {}

    RunObserver observer();
    void print_summary(const RunReport& report);
    /// In any style.
    void warn(const std::string& message);

private:
    using Clock = std::chrono::steady_clock;

    /// A line of its own, or {"event": event, "message": text}.
    void say(const char* event, const std::string& text);
    void begin_frame(const Capture& capture);
    void tell_conventions(const Capture& capture);
    void show_progress(int frame);
    void print_tables(const RunReport& report) const;
    void print_json_summary(const RunReport& report) const;

    ProgressStyle style_;
    int frame_count_ = 0;
    int warmup_frames_ = 0;
    bool verbose_ = false;
    int started_ = 0;
    ProgressLine line_;
    Clock::time_point begin_{};
    std::string profile_;
    std::set<std::string> notes_;  ///< already printed
};

}  // namespace aftershade::cli
