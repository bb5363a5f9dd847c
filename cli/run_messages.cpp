#include "cli/run_messages.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <vector>

#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/capture/frame_range.h"
#include "framework/gpu/context.h"

namespace aftershade::cli {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kMsPerSecond = 1000;

void print_json(const Json& line) {
    fmt::print(stderr, "{}\n", line.dump(-1, ' ', false, Json::error_handler_t::replace));
}

/// Where the time of a run went: what a stage worked, and how long the frames waited for it.
struct Stage {
    const char* name;
    double busy_ms = 0;
    double waited_ms = 0;
};

std::vector<Stage> stages_of(const RunReport& report) {
    Stage decode{"decode", report.decode_ms, report.read_ms}, upload{"upload"}, passes{"passes"},
        readback{"readback"}, encode{"encode", report.encode_ms, report.write_ms};
    for (const PassStatistics& pass : report.passes)
        (pass.pass == upload.name     ? upload
         : pass.pass == readback.name ? readback
                                      : passes)
            .busy_ms += pass.total_ms;
    return {decode, upload, passes, readback, encode};
}

std::vector<int> failed_frames(const RunReport& report) {
    std::vector<int> frames;
    for (const FrameFailure& failure : report.failures) frames.push_back(failure.frame);
    return frames;
}

/// "48 s", "12 min", "3.5 h".
std::string duration_text(double seconds) {
    constexpr double kMinute = 60, kHour = 3600;
    if (seconds < 2 * kMinute) return fmt::format("{:.0f} s", seconds);
    if (seconds < 2 * kHour) return fmt::format("{:.0f} min", seconds / kMinute);
    return fmt::format("{:.1f} h", seconds / kHour);
}

}  // namespace

ProgressStyle parse_progress(const std::string& name) {
    if (name == "none") return ProgressStyle::none;
    if (name == "plain") return ProgressStyle::plain;
    if (name == "json") return ProgressStyle::json;
    if (name == "openjd") return ProgressStyle::openjd;
    if (name == "auto") return isatty(STDERR_FILENO) ? ProgressStyle::terminal : ProgressStyle::plain;
    throw Error(ErrorKind::usage,
                "--progress: '" + name + "' is not one of 'auto', 'none', 'plain', 'json' or 'openjd'");
}

void print_openjd_progress(std::size_t done, std::size_t count, const std::string& status) {
    constexpr double kPercent = 100;
    fmt::print("openjd_progress: {:.1f}\nopenjd_status: {}\n",
               count > 0 ? kPercent * double(done) / double(count) : kPercent, status);
    std::fflush(stdout);
}

std::string fallback_text(const std::string& hardware_fault) {
    return hardware_fault.empty()
               ? ""
               : "; backend auto found no usable hardware GL (" + printable(hardware_fault) + ")";
}

std::string software_warning(const std::string& hardware_fault) {
    return "this machine has a GPU, but no hardware GL could be used, so the frames were drawn in "
           "software: " +
           hardware_fault + " (--backend egl refuses such a run)";
}

std::string warning_line(ProgressStyle style, const std::string& message) {
    const std::string text = "aftershade: warning: " + printable(message);
    if (style != ProgressStyle::json) return text;
    return Json{{"event", "warning"}, {"message", text}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void print_path(std::string_view path) {
    fmt::print("{}\n", path);
    if (std::fflush(stdout) != 0)
        throw Error(ErrorKind::output,
                    std::string("standard output cannot be written: ") + std::strerror(errno));
}

std::string rate_text(std::size_t done, std::size_t count, double elapsed_s) {
    return fmt::format("{:.3g} frames/s, {} left", double(done) / elapsed_s,
                       duration_text(elapsed_s / double(done) * double(count - done)));
}

void ProgressLine::clear() {
    if (is_shown_) fmt::print(stderr, "\r\033[K");
    is_shown_ = false;
}

void ProgressLine::show(ProgressStyle style, const std::string& text) {
    clear();
    is_shown_ = style == ProgressStyle::terminal;
    fmt::print(stderr, "{}{}", text, is_shown_ ? "" : "\n");
    std::fflush(stderr);
}

void RunReporter::say(const char* event, const std::string& text) {
    if (style_ == ProgressStyle::json) return print_json({{"event", event}, {"message", text}});
    line_.clear();
    fmt::print(stderr, "{}\n", printable_lines(text));
}

void RunReporter::warn(const std::string& message) {
    line_.clear();
    fmt::print(stderr, "{}\n", warning_line(style_, message));
}

void RunReporter::tell_conventions(const Capture& capture) {
    const CaptureHeader& header = capture.header;
    const std::string path = header.path.string();
    const std::string profile = "profile " + header.profile + " (" + header.profile_reason + ")";
    if (profile != profile_) say("note", path + ": " + profile);
    profile_ = profile;
    for (const std::string& note : header.notes)
        if (notes_.insert(note).second) say("note", path + ": note: " + printable(note));
    // Figures differ from frame to frame; the first stands for all.
    if (capture.deep && notes_.insert("deep").second)
        say("note", path + ": note: " + capture.deep->text(capture.deep_layers));
    if (capture.pixels_below_albedo_floor > 0)
        say("note", fmt::format("frame {}: {} with light and an albedo below the floor", header.frame,
                                counted(capture.pixels_below_albedo_floor, "pixel")));
    if (capture.pixels_without_motion > 0)
        say("note",
            fmt::format("frame {}: {} pixels have no motion data; {}", header.frame,
                        capture.pixels_without_motion,
                        capture.motion_from_camera ? "filled from camera and depth" : "filled with 0"));
}

void RunReporter::show_progress(int frame) {
    const double elapsed_s = std::chrono::duration<double>(Clock::now() - begin_).count();
    const int done = started_ - 1;
    const double left_s = done > 0 ? elapsed_s / done * (frame_count_ - done) : 0;
    if (style_ == ProgressStyle::json) {
        Json line = {{"event", "frame"},
                     {"frame", frame},
                     {"number", started_},
                     {"of", frame_count_},
                     {"elapsed_s", elapsed_s}};
        if (done > 0) line["left_s"] = left_s;
        return print_json(line);
    }
    std::string text = fmt::format("frame {} ({}/{})", frame, started_, frame_count_);
    if (done > 0) text += ", " + rate_text(std::size_t(done), std::size_t(frame_count_), elapsed_s);
    if (style_ == ProgressStyle::openjd)
        print_openjd_progress(std::size_t(done), std::size_t(frame_count_), text);
    line_.show(style_, text);
}

void RunReporter::begin_frame(const Capture& capture) {
    if (started_++ == 0) begin_ = Clock::now();
    for (const std::string& warning : capture.header.warnings)
        if (notes_.insert(warning).second) warn(capture.header.path.string() + ": " + warning);
    if (style_ == ProgressStyle::none) return;
    tell_conventions(capture);
    show_progress(capture.header.frame);
}

RunObserver RunReporter::observer() {
    RunObserver observer;
    observer.frame_started = [this](const Capture& capture) { begin_frame(capture); };
    observer.file_written = [this](const std::filesystem::path& path) {
        line_.clear();
        print_path(path.string());
    };
    observer.frame_failed = [this](const std::string& message) {
        say("failed", "aftershade: error: " + message);
    };
    observer.non_finite = [this](const std::string& message) { warn(message); };
    observer.frame_differs = [this](const std::string& message) { warn(message); };
    observer.light_cut = [this](const std::string& message) {
        if (style_ != ProgressStyle::none) say("note", "note: " + message);
    };
    observer.frame_missing = [this](int frame, const std::string& what) {
        say("missing", fmt::format("frame {} is missing: {}", frame, what));
    };
    observer.history_reset = [this](int frame, const std::string& reason) {
        say("history", fmt::format("frame {}: history reset: {}", frame, reason));
    };
    observer.native_message = [this](int frame, const std::string& line) {
        if (style_ != ProgressStyle::none) say("native", fmt::format("frame {}: {}", frame, line));
    };
    observer.frame_audited = [this](const CaptureHeader& header, const std::vector<AuditFinding>& findings) {
        if (findings.empty())
            say("audit", fmt::format("audit: frame {}: every value is finite", header.frame));
        for (const AuditFinding& finding : findings)
            say("audit", fmt::format("audit: frame {}: {}", header.frame, describe_finding(finding)));
    };
    return observer;
}

namespace {

/// Says how the draws ran, where any ran as a compute shader.
void print_draws(const std::vector<DrawnPass>& draws) {
    const auto computed = std::ranges::count_if(draws, &DrawnPass::computes);
    if (computed == 0) return;
    std::string others;
    for (const DrawnPass& draw : draws)
        if (!draw.computes) others += fmt::format("; {} {}", draw.pass, draw.why_drawn);
    fmt::print(stderr, "{} of {} draws ran as compute shaders{}\n", computed, draws.size(),
               printable(others));
}

}  // namespace

void RunReporter::print_tables(const RunReport& report) const {
    fmt::print(stderr, "{:<28} {:>9} {:>9} {:>9}   ms a frame, {} clock\n", "pass", "mean", "min", "max",
               report.clock);
    for (const PassStatistics& pass : report.passes)
        fmt::print(stderr, "{:<28} {:>9.2f} {:>9.2f} {:>9.2f}\n", pass.pass, pass.total_ms / pass.frames,
                   pass.min_ms, pass.max_ms);
    print_draws(report.draws);
    fmt::print(stderr, "{:<28} {:>9} {:>9}   s in all; decode and encode work beside the frames\n", "stage",
               "busy", "waited");
    for (const Stage& stage : stages_of(report))
        fmt::print(stderr, "{:<28} {:>9.2f} {:>9.2f}\n", stage.name, stage.busy_ms / kMsPerSecond,
                   stage.waited_ms / kMsPerSecond);
    fmt::print(stderr, "waited {:.2f} s for files to be read, {:.2f} s to be written\n",
               report.read_ms / kMsPerSecond, report.write_ms / kMsPerSecond);
    constexpr double kMiB = 1024 * 1024;
    fmt::print(stderr, "textures and buffers: {:.1f} MiB ({:.1f} MiB without sharing memory)\n",
               double(report.bytes) / kMiB, double(report.bytes_unaliased) / kMiB);
    const int frames = std::max(1, report.frames_done + report.frames_unwritten);
    fmt::print(stderr,
               "transfers: {}, {:.1f} MiB of buffers; a frame waited {:.2f} ms for uploads, {:.2f} ms for "
               "readbacks\n",
               report.gl.maps_transfers ? "mapped" : "direct", double(report.transfers.buffer_bytes) / kMiB,
               report.transfers.upload_ms / frames, report.transfers.read_ms / frames);
}

void RunReporter::print_json_summary(const RunReport& report) const {
    Json stages = Json::object();
    for (const Stage& stage : stages_of(report))
        stages[stage.name] = {{"busy_s", stage.busy_ms / kMsPerSecond},
                              {"waited_s", stage.waited_ms / kMsPerSecond}};
    print_json({{"event", "end"},
                {"frames_done", report.frames_done},
                {"of", frame_count_},
                {"failed", failed_frames(report)},
                {"skipped", report.frames_skipped},
                {"non_finite", report.frames_non_finite},
                {"interrupted", report.interrupted},
                {"wall_s", report.wall_ms / kMsPerSecond},
                {"stages", stages}});
}

void RunReporter::print_summary(const RunReport& report) {
    line_.clear();
    if (style_ == ProgressStyle::none) return;
    frame_count_ -= warmup_frames_ + report.frames_unwritten;  // what was to be written
    if (style_ == ProgressStyle::json) return print_json_summary(report);
    if (style_ == ProgressStyle::openjd)
        print_openjd_progress(std::size_t(frame_count_), std::size_t(frame_count_),
                              fmt::format("{} of {} frames done", report.frames_done, frame_count_));
    if (verbose_ && report.frames_done > 0) print_tables(report);
    if (!report.frames_non_finite.empty())
        fmt::print(stderr, "NaN or infinite pixels in {} of {} frames: {}\n", report.frames_non_finite.size(),
                   frame_count_, format_frame_range(report.frames_non_finite));
    if (!report.failures.empty())
        fmt::print(stderr, "{} of {} frames failed: {}\n", report.failures.size(), frame_count_,
                   format_frame_range(failed_frames(report)));
    fmt::print(stderr, "{} of {} frames in {:.2f} s", report.frames_done, frame_count_,
               report.wall_ms / kMsPerSecond);
    if (!report.gl.renderer.empty())
        fmt::print(stderr, ", {}: {}, {}", gpu::backend_name(report.gl.backend), report.gl.renderer,
                   report.gl.version);
    fmt::print(stderr, "{}\n", fallback_text(report.gl.hardware_fault));
}

}  // namespace aftershade::cli
