// The main job: frames in, pipeline over each, files out.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "framework/image/capture.h"
#include "framework/pipeline/output.h"
#include "framework/pipeline/pipeline.h"

namespace aftershade {

/// Milliseconds of one pass over all frames.
struct PassStatistics {
    std::string pass;
    double total_ms = 0;
    double min_ms = 0;
    double max_ms = 0;
    int frames = 0;
};

/// What to do where a frame's file is not there.
enum class MissingFrame {
    error,  ///< the frame has failed
    skip,   ///< leave it out
    hold    ///< run the last frame that was there again, under this frame's number
};

struct RunOptions {
    std::vector<int> frames;
    MissingFrame missing = MissingFrame::error;
    bool audit = false;
};

struct RunReport {
    int frames_done = 0;
    std::vector<std::string> failures;   ///< one message per frame that could not be read
    int frames_skipped = 0;              ///< missing, and MissingFrame::skip
    std::vector<PassStatistics> passes;  ///< in the order of the passes
    double read_ms = 0;                  ///< waiting for frames to be read and decoded
    double write_ms = 0;                 ///< waiting for files to be written
    double wall_ms = 0;
    bool interrupted = false;
    ExitCode exit_code() const;
};

/// Called on the caller's thread. Any may be empty.
struct RunObserver {
    std::function<void(const Capture&)> frame_started;
    std::function<void(const std::filesystem::path&)> file_written;
    std::function<void(const std::string&)> frame_failed;
    std::function<void(const CaptureHeader&, const std::vector<AuditFinding>&)> frame_audited;
    std::function<void(int frame, const std::string& what)> frame_missing;  ///< skipped or held
};

/// Reads the next frame and writes the last one while the GPU works. A frame that cannot be read is reported
/// and left out; an effect or an output that fails ends the run by its Error. `stop` is looked at between
/// frames.
RunReport run_frames(gpu::Context& context, const Pipeline& pipeline, const CaptureReader& reader,
                     const RunOptions& run, const OutputOptions& outputs,
                     const std::filesystem::path& data_folder, const RunObserver& observer,
                     const std::atomic<bool>& stop);

}  // namespace aftershade
