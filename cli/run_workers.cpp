#include "cli/run_workers.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/batch_report.h"
#include "cli/command_line.h"
#include "cli/run_continuation.h"
#include "framework/base/atomic_file.h"
#include "framework/base/cores.h"
#include "framework/base/text.h"
#include "framework/batch/run_jobs.h"
#include "framework/capture/frame_range.h"
#include "framework/gpu/device.h"
#include "framework/look/object_matches.h"
#include "framework/run/run_lock.h"

namespace aftershade::cli {

namespace {

using Clock = std::chrono::steady_clock;

/// Prints what workers say, each line once, and how far the run is.
class WorkersReporter {
public:
    WorkersReporter(ProgressStyle style, std::size_t frame_count, const Pipeline& pipeline)
        : style_(style), frame_count_(frame_count), objects_(pipeline) {}

    JobListener listener() {
        JobListener listener;
        listener.on_stdout = [this](std::string_view line) {
            line_.clear();
            print_path(line);
        };
        listener.on_stderr = [this](std::string_view line) {
            // Every worker says the same of what all frames have in common.
            if (!said_.emplace(line).second) return;
            line_.clear();
            fmt::print(stderr, "{}\n", line);
        };
        listener.on_frame = [this](const FrameEvent& event) { frame(event); };
        listener.on_object = [this](const ObjectSighting& sighting) { objects_.add(sighting); };
        return listener;
    }

    void finish(const JobsReport& report, std::size_t workers, double seconds) {
        line_.clear();
        const std::string& fault = report.gl.hardware_fault;
        if (!fault.empty() && gpu::has_gpu_file("/"))
            fmt::print(stderr, "{}\n", warning_line(style_, software_warning(fault)));
        fmt::print(stderr, "{}", failures_text(report.frames));
        for (const std::string& warning : objects_.unmatched())
            fmt::print(stderr, "{}\n", warning_line(style_, warning));
        if (style_ == ProgressStyle::none || style_ == ProgressStyle::json) return;
        const int done = count_outcome(report.frames, "done");
        const int current = count_outcome(report.frames, "current");
        if (current > 0)
            fmt::print(stderr, "{} {} current\n", current, current == 1 ? "frame was" : "frames were");
        fmt::print(stderr, "{} of {} frames in {:.2f} s by {}; {:.2f} frames/s{}\n", done, frame_count_,
                   seconds, counted(workers, "worker"), seconds > 0 ? double(done) / seconds : 0.0,
                   fallback_text(fault));
    }

private:
    void frame(const FrameEvent& event) {
        ++ended_;
        if (style_ == ProgressStyle::none) return;
        const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
        const double left = seconds / double(ended_) * double(frame_count_ - ended_);
        if (style_ == ProgressStyle::json) {
            const nlohmann::ordered_json line = {{"event", "frame"},         {"frame", event.frame},
                                                 {"outcome", event.outcome}, {"done", ended_},
                                                 {"frames", frame_count_},   {"seconds_left", left}};
            fmt::print(stderr, "{}\n", line.dump());
            return;
        }
        if (style_ == ProgressStyle::openjd)
            print_openjd_progress(ended_, frame_count_,
                                  fmt::format("frame {} {}", event.frame, event.outcome));
        line_.show(style_, fmt::format("frame {} {} ({}/{}), {}", event.frame, event.outcome, ended_,
                                       frame_count_, rate_text(ended_, frame_count_, seconds)));
    }

    ProgressStyle style_;
    std::size_t frame_count_;
    std::size_t ended_ = 0;
    ProgressLine line_;
    ObjectMatches objects_;
    std::set<std::string, std::less<>> said_;
    Clock::time_point start_ = Clock::now();
};

/// This process's command without what is its own. Frames are ranges: a word of a command line has at most
/// 128 KiB (execve(2), MAX_ARG_STRLEN).
std::vector<std::string> worker_command(const RunArguments& arguments, const JobPiece& piece,
                                        std::size_t frames, int threads, const std::string& device) {
    std::vector<std::string> command =
        with_options(own_arguments(), {{"--jobs", ""},
                                       {"--frame-timeout", ""},
                                       {"--max-memory", ""},
                                       {"--report", ""},
                                       {"--progress", "none"},
                                       {"--worker-frames", format_frame_range(piece.frames)},
                                       {"--worker-warmup", std::to_string(piece.warmup_frames)},
                                       {"--worker-threads", std::to_string(threads)},
                                       {"--device", device}});
    std::erase(command, "--stop-on-error");
    // A worker of one frame keeps the journal that the run keeps.
    if (arguments.resume.keeps_journal(frames) && !arguments.resume.resume)
        command.insert(command.begin() + 2, "--resume");
    command[0] = "/proc/self/exe";
    return command;
}

/// What a worker takes of the address space before its first frame: the program itself, and what
/// gpu::Context requires. Below that, libraries crash as they are loaded.
constexpr std::uint64_t kMiB = 1024 * 1024, kLeastWorkerBytes = (40 + 320) * kMiB;

void require_room_for_a_worker(std::uint64_t limit) {
    if (limit < kLeastWorkerBytes)
        throw Error(ErrorKind::memory,
                    fmt::format("out of memory: --max-memory {} is too little for a worker; "
                                "write --max-memory {}MB or more",
                                limit, kLeastWorkerBytes / kMiB));
}

/// Killed workers leave temporary files, and their lines in the locks of the outputs. A lock of the same
/// frames takes these away. Where another run holds one, that run will.
void clear_after_workers(const RunArguments& arguments, const std::vector<int>& frames) {
    std::set<std::filesystem::path> folders;
    for (const std::string& pattern : arguments.outputs) {
        for (const int frame : frames)
            folders.insert(std::filesystem::path(FramePattern(pattern).path(frame)).parent_path());
        if (arguments.resume.keeps_journal(frames.size())) try {
                RunLock(pattern, frames, printed_command(own_arguments()));
            } catch (const Error&) {
            }
    }
    for (const std::filesystem::path& folder : folders) remove_stale_temporaries(folder);
}

}  // namespace

void check_worker_options(const RunArguments& arguments, Diagnostics& diagnostics) {
    if (!arguments.jobs.wants_workers()) return;
    const auto refuse = [&](bool is_given, const std::string& option, const char* remedy) {
        if (is_given)
            diagnostics.error({option},
                              "needs all frames in one process, which --jobs, --frame-timeout and "
                              "--max-memory do not give it; " +
                                  std::string(remedy));
    };
    refuse(!arguments.graph.empty(), "--graph", "draw the graph of one frame in a run of its own");
    refuse(!arguments.telemetry_plot.empty(), "--telemetry-plot", "write --telemetry FILE_####.json");
    refuse(!arguments.trace.empty(), "--trace", "trace a run of a few frames");
    refuse(!arguments.history_in.empty(), "--history-in", "leave --jobs out, or let chunks warm up");
    refuse(!arguments.history_out.empty(), "--history-out", "leave --jobs out, or let chunks warm up");
    refuse(arguments.streams(), "-o " + arguments.stream_output(),
           "leave --jobs out, or write out_####.png, which ffmpeg reads, too");
    refuse(arguments.watch, "--watch", "leave one of them out");
    refuse(arguments.resume.dry_run, "--dry-run", "ask without workers");
}

ExitCode run_by_workers(const RunArguments& arguments, const JobFrames& frames, int workers,
                        const Pipeline& pipeline, ProgressStyle progress, const std::atomic<bool>& stop) {
    const auto start = Clock::now();
    JobOptions options;
    options.pieces = plan_jobs(frames, workers);
    options.warmup_frames = frames.has_history ? frames.warmup_frames : 0;
    options.threads = std::max(1, allotted_cores() / std::max(1, int(options.pieces.size())));
    std::vector<std::string> devices;  // of the pieces
    for (int i = 0; i < int(options.pieces.size()); ++i) devices.push_back(chosen_gl(arguments.gl, i).device);
    options.command = [&](const JobPiece& piece, int number) {
        return worker_command(arguments, piece, frames.count(), options.threads,
                              devices[std::size_t(number)]);
    };
    if (arguments.jobs.frame_timeout_s > 0)
        options.frame_timeout = std::chrono::duration<double>(arguments.jobs.frame_timeout_s);
    if (arguments.jobs.memory_bytes > 0) {
        require_room_for_a_worker(arguments.jobs.memory_bytes);
        options.memory_bytes = arguments.jobs.memory_bytes;
    }
    options.pass_limit = arguments.plugins.pass_limit();
    if (pipeline.has_foreign()) options.resident_bytes = foreign_memory_bytes() / options.pieces.size();
    options.stop_on_error = arguments.jobs.stop_on_error;
    WorkersReporter reporter(progress, frames.count(), pipeline);
    const std::vector<int> written(frames.frames.begin() + frames.lead_frames, frames.frames.end());
    JobsReport report;
    try {
        report = run_jobs(options, reporter.listener(), stop);
    } catch (...) {
        clear_after_workers(arguments, written);
        throw;
    }
    clear_after_workers(arguments, written);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    reporter.finish(report, options.pieces.size(), seconds);
    if (report.interrupted)
        print_interruption(
            progress, arguments,
            {count_outcome(report.frames, "done") + count_outcome(report.frames, "current"),
             int(report.frames.size()), count_outcome(report.frames, "not run") == 0, frames.has_history});
    if (!arguments.jobs.report.empty())
        write_text_file(arguments.jobs.report,
                        report_json({arguments.look, arguments.capture.capture, report.frames, seconds,
                                     report.exit_code, report.gl, report.error}));
    return report.exit_code;
}

}  // namespace aftershade::cli
