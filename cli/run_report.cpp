#include "cli/run_report.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "framework/core/text.h"

namespace aftershade::cli {

ProgressStyle parse_progress(const std::string& name) {
    if (name == "none") return ProgressStyle::none;
    if (name == "plain") return ProgressStyle::plain;
    if (name == "auto") return isatty(STDERR_FILENO) ? ProgressStyle::terminal : ProgressStyle::plain;
    throw Error(ExitCode::usage, "--progress: '" + name + "' is not one of 'auto', 'none' or 'plain'");
}

void RunReporter::clear_line() {
    if (has_line_) fmt::print(stderr, "\r\033[K");
    has_line_ = false;
}

RunObserver RunReporter::observer() {
    RunObserver observer;
    observer.frame_started = [this](const Capture& capture) {
        const CaptureHeader& header = capture.header;
        ++started_;
        if (style_ == ProgressStyle::none) return;
        const std::string profile = "profile " + header.profile + " (" + header.profile_reason + ")";
        if (profile != profile_) {
            clear_line();
            fmt::print(stderr, "{}: {}\n", header.path.string(), profile);
            profile_ = profile;
        }
        for (const std::string& note : header.notes) {
            if (!notes_.insert(note).second) continue;
            clear_line();
            fmt::print(stderr, "{}: note: {}\n", header.path.string(), printable(note));
        }
        if (capture.pixels_without_motion > 0) {
            clear_line();
            fmt::print(stderr, "frame {}: {} pixels have no motion data; {}\n", header.frame,
                       capture.pixels_without_motion,
                       capture.motion_from_camera ? "filled from camera and depth" : "filled with 0");
        }
        if (style_ == ProgressStyle::plain) {
            fmt::print(stderr, "frame {} ({}/{})\n", header.frame, started_, frame_count_);
            return;
        }
        clear_line();
        fmt::print(stderr, "frame {} ({}/{})", header.frame, started_, frame_count_);
        std::fflush(stderr);
        has_line_ = true;
    };
    observer.file_written = [this](const std::filesystem::path& path) {
        clear_line();
        fmt::print("{}\n", path.string());
        std::fflush(stdout);
    };
    observer.frame_failed = [this](const std::string& message) {
        clear_line();
        fmt::print(stderr, "aftershade: error: {}\n", message);
    };
    observer.frame_missing = [this](int frame, const std::string& what) {
        clear_line();
        fmt::print(stderr, "frame {} is missing: {}\n", frame, what);
    };
    observer.history_reset = [this](int frame, const std::string& reason) {
        clear_line();
        fmt::print(stderr, "frame {}: history begins anew: {}\n", frame, reason);
    };
    observer.native_message = [this](int frame, const std::string& line) {
        if (style_ == ProgressStyle::none) return;
        clear_line();
        fmt::print(stderr, "frame {}: {}\n", frame, line);
    };
    observer.frame_audited = [this](const CaptureHeader& header, const std::vector<AuditFinding>& findings) {
        clear_line();
        if (findings.empty()) fmt::print(stderr, "audit: frame {}: every value is finite\n", header.frame);
        for (const AuditFinding& finding : findings)
            fmt::print(stderr, "audit: frame {}: {}\n", header.frame, describe_finding(finding));
    };
    return observer;
}

void RunReporter::print_summary(const RunReport& report, const std::string& clock) {
    clear_line();
    if (style_ == ProgressStyle::none || report.frames_done == 0) return;
    fmt::print(stderr, "{:<28} {:>9} {:>9} {:>9}   ms a frame, {} clock\n", "pass", "mean", "min", "max",
               clock);
    for (const PassStatistics& pass : report.passes)
        fmt::print(stderr, "{:<28} {:>9.2f} {:>9.2f} {:>9.2f}\n", pass.pass, pass.total_ms / pass.frames,
                   pass.min_ms, pass.max_ms);
    fmt::print(stderr,
               "{} of {} frames in {:.2f} s; waited {:.2f} s for files to be read, {:.2f} s to be written\n",
               report.frames_done, frame_count_, report.wall_ms / 1000, report.read_ms / 1000,
               report.write_ms / 1000);
    constexpr double kMiB = 1024 * 1024;
    fmt::print(stderr, "textures and buffers: {:.1f} MiB ({:.1f} MiB without sharing memory)\n",
               double(report.bytes) / kMiB, double(report.bytes_unaliased) / kMiB);
}

}  // namespace aftershade::cli
