// A run of many frames by several worker processes, each of them `aftershade run` over some of the frames.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/batch/job_plan.h"
#include "framework/batch/process_codes.h"
#include "framework/batch/watchdog.h"
#include "framework/batch/worker.h"

namespace aftershade {

struct JobOptions {
    std::vector<JobPiece> pieces;  ///< one worker each, all at the same time
    /// The command of the worker of the piece `number`; the first is the program's path.
    std::function<std::vector<std::string>(const JobPiece&, int number)> command;
    int warmup_frames = 0;  ///< before the frames of a worker that continues after a failed one
    int threads = 1;        ///< of each worker, for GL on software and for files
    std::chrono::duration<double> frame_timeout{std::chrono::duration<double>::max()};
    PassLimit pass_limit;
    std::optional<std::uint64_t> memory_bytes;    ///< address space of each worker (RLIMIT_AS)
    std::optional<std::uint64_t> resident_bytes;  ///< memory that each worker really uses
    bool stop_on_error = false;                   ///< the first frame that fails ends the run
};

/// Called on the workers' threads, one call at a time. Any may be empty.
struct JobListener {
    std::function<void(std::string_view line)> on_stdout;
    std::function<void(std::string_view line)> on_stderr;
    std::function<void(const FrameEvent& event)> on_frame;
    std::function<void(const ObjectSighting& sighting)> on_object;
};

struct JobsReport {
    std::vector<FrameEvent> frames;  ///< by frame; "not run" of those that an interrupt or an error left over
    bool interrupted = false;
    /// done, partial, interrupted; or, where no frame was made, what the workers ended with.
    ExitCode exit_code = ExitCode::done;
    DrawnBy gl{};       ///< of a worker that fell back to software, else of any
    std::string error;  ///< the message of an error that ended the run for every worker; "" without one
};

/// Runs the pieces. A worker that crashes, runs out of memory, says nothing for `frame_timeout` or is longer
/// at a pass than its limit costs the frame that it was at; another one continues after that frame, where the
/// look has history after the piece's warm-up. Three workers in turn that finish no frame give their piece
/// up, and so does an error that every other frame would meet (usage, GL, output).
JobsReport run_jobs(const JobOptions& options, const JobListener& listener, const std::atomic<bool>& stop);

}  // namespace aftershade
